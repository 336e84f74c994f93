#include "page/page_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "page/packed.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHostile = "</script><img src=x onerror=alert(1)>\"'&";

PageText hostile_page(const PageAccess& access = {}) {
  return page_text({{"campaign", {{"name", kHostile}, {"categories", {kHostile}}}}}, access);
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

TEST(Base64, HoldsTheVectorsOfItsRfc) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\x00"), "//4=") << "the text ends at the zero";
  EXPECT_EQ(base64(std::string_view("\xff\xfe\x00", 3)), "//4A");
}

TEST(Columns, SayWhatTheyAre) {
  const Json column = column_of(std::vector<std::uint16_t>{1, 2, 3});
  EXPECT_EQ(column.at("type"), "uint16");
  EXPECT_EQ(column.at("count"), 3);
  EXPECT_EQ(column_of(std::vector<float>{}).at("count"), 0);
}

TEST(ScriptJson, EndsNoElementAndStaysTheSameValue) {
  const Json value = {{"text", kHostile}, {"comment", "<!--"}};
  const std::string text = script_json(value);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(Json::parse(text), value);
}

TEST(HtmlText, IsTextWhereverItStands) {
  EXPECT_EQ(html_text(kHostile),
            "&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;&#39;&amp;");
}

TEST(PageText, HasNothingOfAStrangersAsMarkup) {
  const std::string page = hostile_page().begin;
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(between(page, "<title>", "</title>"), HasSubstr("&lt;img"));
  EXPECT_THAT(page, Not(HasSubstr("{{"))) << "all is filled in";
}

TEST(PageText, AllowsItsOwnScriptsAndStyleAlone) {
  const std::string page = hostile_page().begin;
  const std::string policy = between(page, "Content-Security-Policy\" content=\"", "\">");
  EXPECT_THAT(policy, HasSubstr("default-src &#39;none&#39;"));
  EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
  EXPECT_THAT(policy, Not(HasSubstr("connect-src")));
  EXPECT_THAT(policy, Not(HasSubstr("http")));
  const std::string style = between(page, "<style>", "</style>");
  std::string digest;
  const std::string hex = sha256_hex(style);
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    digest += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  }
  EXPECT_THAT(policy, HasSubstr("sha256-" + base64(digest)));
}

TEST(PageText, AsksForMoreOnlyWhereItMay) {
  EXPECT_THAT(hostile_page({.connects = true, .loads_parts = false}).begin,
              HasSubstr("connect-src &#39;self&#39;"));
  EXPECT_THAT(hostile_page({.connects = false, .loads_parts = true}).begin, HasSubstr("file:"));
}

TEST(PageText, HasTheLicenceOfWhatItBringsAlong) {
  EXPECT_THAT(hostile_page().begin, HasSubstr("Permission is hereby granted"));
}

}  // namespace
}  // namespace seedframe
