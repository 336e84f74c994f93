#include "live/gate.h"

#include <array>
#include <cstdio>

#include <fmt/format.h>
#include <sys/random.h>

namespace seedframe {
namespace {

constexpr std::size_t kTokenBytes = 16;

HttpResponse refused(int status, std::string why) {
  return {.status = status, .body = std::move(why) + "\n"};
}

/// In a time that does not tell how much of it is right.
bool is_same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

/// The value of a cookie; empty if it was not sent.
std::string cookie(const std::string& header, const std::string& name) {
  std::size_t at = 0;
  while (at < header.size()) {
    const std::size_t end = std::min(header.find(';', at), header.size());
    const std::size_t begin = header.find_first_not_of(' ', at);
    const std::string pair = begin < end ? header.substr(begin, end - begin) : std::string();
    if (pair.starts_with(name + "=")) return pair.substr(name.size() + 1);
    at = end + 1;
  }
  return {};
}

}  // namespace

Gate::Gate(std::string token, int port) : token_(std::move(token)), port_(port) {}

std::string Gate::random_token() {
  std::array<unsigned char, kTokenBytes> bytes{};
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::getrandom(bytes.data() + filled, bytes.size() - filled, 0);
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string Gate::address() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port_, token_);
}

bool Gate::is_ours(const std::string& host) const {
  return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
}

/// Cookies do not tell ports apart: each server has one of its own.
std::string Gate::cookie_name() const { return fmt::format("seedframe_{}", port_); }

bool Gate::has_token(const HttpRequest& request) const {
  return is_same_secret(cookie(request.header("cookie"), cookie_name()), token_) ||
         is_same_secret(request.header("x-seedframe-token"), token_);
}

std::optional<HttpResponse> Gate::refusal(const HttpRequest& request) const {
  if (!is_ours(request.header("host"))) return refused(403, "This is not its name.");
  if (request.method != "GET" && request.method != "POST") {
    return refused(405, "There are GET and POST.");
  }
  const auto token = request.query.find("token");
  if (request.method == "GET" && request.path == "/" && token != request.query.end()) {
    if (!is_same_secret(token->second, token_)) return refused(403, "That is not the token.");
    // Out of the address, and so out of the history and of what is shown to others.
    return HttpResponse{.status = 303,
                        .body = {},
                        .headers = {{"Location", "/"},
                                    {"Set-Cookie", fmt::format("{}={}; Path=/; HttpOnly; "
                                                               "SameSite=Strict",
                                                               cookie_name(), token_)}}};
  }
  if (!has_token(request)) {
    return refused(403, "Open the address that 'seedframe serve' has printed: it holds the token.");
  }
  if (request.method == "GET") return std::nullopt;
  const std::string origin = request.header("origin");
  constexpr std::string_view kScheme = "http://";
  const bool from_here = origin.starts_with(kScheme) && is_ours(origin.substr(kScheme.size()));
  if (!from_here || request.header("x-seedframe") != "1") {
    return refused(403, "Only pages of this server may ask for that.");
  }
  return std::nullopt;
}

HttpResponse hardened(HttpResponse response) {
  response.headers["Cache-Control"] = "no-store";
  response.headers["X-Content-Type-Options"] = "nosniff";
  response.headers["X-Frame-Options"] = "DENY";
  response.headers["Content-Security-Policy"] = "frame-ancestors 'none'";
  response.headers["Referrer-Policy"] = "no-referrer";
  response.headers["Cross-Origin-Resource-Policy"] = "same-origin";
  response.headers["Cross-Origin-Opener-Policy"] = "same-origin";
  return response;
}

}  // namespace seedframe
