#include "live/gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

constexpr int kPort = 8123;
const std::string kToken = "00112233445566778899aabbccddeeff";

HttpRequest get(const std::string& path = "/c/0/") {
  return {.method = "GET",
          .path = path,
          .query = {},
          .headers = {{"host", "127.0.0.1:8123"}, {"cookie", "seedframe_8123=" + kToken}}};
}

HttpRequest post(const std::string& path = "/c/0/pause") {
  HttpRequest request = get(path);
  request.method = "POST";
  request.headers["origin"] = "http://127.0.0.1:8123";
  request.headers["x-seedframe"] = "1";
  return request;
}

/// Status of the refusal; 0: it is let in.
int refused(const HttpRequest& request) {
  const auto refusal = Gate(kToken, kPort).refusal(request);
  return refusal ? refusal->status : 0;
}

TEST(Gate, LetsInWhoHasTheToken) {
  EXPECT_EQ(refused(get()), 0);
  EXPECT_EQ(refused(post()), 0);
  HttpRequest script = get();
  script.headers.erase("cookie");
  script.headers["x-seedframe-token"] = kToken;
  EXPECT_EQ(refused(script), 0);
}

TEST(Gate, RefusesWhoHasNotTheToken) {
  HttpRequest request = get();
  for (const std::string& cookie :
       {std::string(), std::string("seedframe_8123="), "seedframe_8123=" + kToken.substr(1),
        "seedframe_8123=" + kToken + "0", "seedframe_8124=" + kToken, "xseedframe_8123=" + kToken,
        "a=seedframe_8123=" + kToken}) {
    request.headers["cookie"] = cookie;
    EXPECT_EQ(refused(request), 403) << cookie;
  }
  request.headers["cookie"] = "a=b; seedframe_8123=" + kToken + "; c=d";
  EXPECT_EQ(refused(request), 0) << "among others";
}

TEST(Gate, AnotherNameForTheSameMachineIsRefused) {
  HttpRequest request = get();
  for (const char* host : {"evil.example", "evil.example:8123", "127.0.0.1", "127.0.0.1:80",
                           "localhost:81230", "localhost:8123.evil.example", "", "[::1]:8123"}) {
    request.headers["host"] = host;
    EXPECT_EQ(refused(request), 403) << host;
  }
  request.headers["host"] = "localhost:8123";
  EXPECT_EQ(refused(request), 0);
}

TEST(Gate, APostComesFromAPageOfThisServerOnly) {
  for (const char* origin : {"", "null", "http://evil.example", "https://127.0.0.1:8123",
                             "http://127.0.0.1:8124", "http://127.0.0.1:8123.evil.example"}) {
    HttpRequest request = post();
    request.headers["origin"] = origin;
    EXPECT_EQ(refused(request), 403) << origin;
  }
  HttpRequest form = post();
  form.headers.erase("x-seedframe");
  EXPECT_EQ(refused(form), 403) << "no form can send that header";
}

TEST(Gate, ThereAreNoOtherMethods) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "get", ""}) {
    HttpRequest request = get();
    request.method = method;
    EXPECT_EQ(refused(request), 405) << method;
  }
}

TEST(Gate, TheAddressIsExchangedForACookie) {
  const Gate gate(kToken, kPort);
  EXPECT_EQ(gate.address(), "http://127.0.0.1:8123/?token=" + kToken);
  HttpRequest request = get("/");
  request.headers.erase("cookie");
  request.query["token"] = kToken;
  const auto answer = gate.refusal(request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 303);
  EXPECT_EQ(answer->headers.at("Location"), "/") << "the token is out of the address";
  EXPECT_THAT(answer->headers.at("Set-Cookie"), HasSubstr("HttpOnly; SameSite=Strict"));
  request.query["token"] = kToken.substr(0, 31) + "0";
  EXPECT_EQ(refused(request), 403);
  request.query["token"] = kToken;
  request.headers["host"] = "evil.example:8123";
  EXPECT_EQ(refused(request), 403) << "not even with the token";
}

TEST(Gate, TokensHave128BitsAndAreOthersEachTime) {
  EXPECT_THAT(Gate::random_token(), MatchesRegex("[0-9a-f]{32}"));
  EXPECT_NE(Gate::random_token(), Gate::random_token());
}

TEST(Gate, AnswersAreNotStoredFramedOrReadByOtherSites) {
  const HttpResponse answer = hardened({.body = "x"});
  EXPECT_EQ(answer.headers.at("Cache-Control"), "no-store");
  EXPECT_EQ(answer.headers.at("X-Content-Type-Options"), "nosniff");
  EXPECT_THAT(answer.headers.at("Content-Security-Policy"), HasSubstr("frame-ancestors 'none'"));
  EXPECT_EQ(answer.headers.at("Cross-Origin-Resource-Policy"), "same-origin");
  EXPECT_FALSE(answer.headers.contains("Access-Control-Allow-Origin"));
}

}  // namespace
}  // namespace seedframe
