// A request and its answer, without the sockets that carry them.
#pragma once

#include <map>
#include <string>

namespace seedframe {

struct HttpRequest {
  std::string method = {};                          ///< "GET", "POST", …
  std::string path = {};                            ///< "/c/0/live", decoded
  std::map<std::string, std::string> query = {};    ///< decoded
  std::map<std::string, std::string> headers = {};  ///< names in lower case

  /// Empty if it is not there.
  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
  }
};

struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::map<std::string, std::string> headers = {};
};

}  // namespace seedframe
