// Who may ask: the user's own browser, from pages of this server, and nobody else.
#pragma once

#include <optional>
#include <string>

#include "live/http.h"

namespace seedframe {

class Gate {
 public:
  /// `token`: a secret that the user gets in the address.
  Gate(std::string token, int port);

  /// 32 hex digits from the system's randomness.
  static std::string random_token();

  /// "http://127.0.0.1:8000/?token=…": what the user is told.
  std::string address() const;

  /// What to answer instead; nothing: the request may be served. Refused are: another Host than
  /// 127.0.0.1 or localhost at the port, as a name that was bound anew (DNS rebinding) has; one
  /// without the token, in the cookie that the address gives or in X-Seedframe-Token; other methods
  /// than GET and POST; a POST that does not come from a page of this server (Origin, and a header
  /// that no form can send).
  std::optional<HttpResponse> refusal(const HttpRequest& request) const;

 private:
  bool is_ours(const std::string& host) const;
  bool has_token(const HttpRequest& request) const;
  std::string cookie_name() const;

  std::string token_;
  int port_;
};

/// With what every answer has: it is not stored, framed, guessed at or read by other sites.
HttpResponse hardened(HttpResponse response);

}  // namespace seedframe
