#include "live/http_server.h"

#include <httplib.h>

namespace seedframe {
namespace {

constexpr std::size_t kThreads = 4;
constexpr std::size_t kMostBody = 1024;  // no request has any
constexpr time_t kPatienceSeconds = 5;

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

/// A header that is given twice is none that anybody may trust.
HttpRequest request_of(const httplib::Request& from) {
  HttpRequest request{.method = from.method, .path = from.path};
  for (const auto& [name, value] : from.params) request.query[name] = value;
  for (const auto& [name, value] : from.headers) {
    const auto [place, is_new] = request.headers.try_emplace(lower_case(name), value);
    if (!is_new) place->second.clear();
  }
  return request;
}

void put(const HttpResponse& answer, httplib::Response& to) {
  to.status = answer.status;
  for (const auto& [name, value] : answer.headers) to.set_header(name, value);
  to.set_content(answer.body, answer.type);
}

}  // namespace

struct HttpServer::Sockets {
  httplib::Server server;
  int port = 0;
};

HttpServer::HttpServer(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
HttpServer::~HttpServer() = default;
HttpServer::HttpServer(HttpServer&&) noexcept = default;
HttpServer& HttpServer::operator=(HttpServer&&) noexcept = default;

Result<HttpServer> HttpServer::bind(int port) {
  auto sockets = std::make_unique<Sockets>();
  httplib::Server& server = sockets->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // A connection that is kept would be looked at a hundred times a second.
  server.set_keep_alive_max_count(1);
  server.set_read_timeout(kPatienceSeconds);
  server.set_write_timeout(kPatienceSeconds);
  server.set_payload_max_length(kMostBody);
  constexpr const char* kAddress = "127.0.0.1";
  if (port == 0) {
    sockets->port = server.bind_to_any_port(kAddress);
  } else {
    sockets->port = server.bind_to_port(kAddress, port) ? port : -1;
  }
  if (sockets->port <= 0) {
    return fail(ErrorKind::kInput, "port {} of {} cannot be had: another one may listen there",
                port, kAddress);
  }
  return HttpServer(std::move(sockets));
}

int HttpServer::port() const { return sockets_->port; }

void HttpServer::serve(const std::function<HttpResponse(const HttpRequest&)>& answer) {
  sockets_->server.set_pre_routing_handler(
      [&answer](const httplib::Request& from, httplib::Response& to) {
        put(answer(request_of(from)), to);
        return httplib::Server::HandlerResponse::Handled;
      });
  sockets_->server.listen_after_bind();
}

void HttpServer::stop() { sockets_->server.stop(); }

}  // namespace seedframe
