// The sockets: requests from this machine to a LiveSite.
#pragma once

#include <functional>
#include <memory>

#include "base/error.h"
#include "live/http.h"

namespace seedframe {

class HttpServer {
 public:
  /// Takes a port of 127.0.0.1; 0: any that is free. kInput: it is taken.
  static Result<HttpServer> bind(int port);
  ~HttpServer();
  HttpServer(HttpServer&&) noexcept;
  HttpServer& operator=(HttpServer&&) noexcept;

  int port() const;
  /// Until stop(), from any thread; `answer` is called from several at once.
  void serve(const std::function<HttpResponse(const HttpRequest&)>& answer);
  void stop();

 private:
  struct Sockets;
  explicit HttpServer(std::unique_ptr<Sockets> sockets);
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace seedframe
