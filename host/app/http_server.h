// HTTP server: answers a browser on this machine until a signal comes.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace raygate {

/// What a browser asks: the query's names and values, decoded.
struct HttpRequest {
  std::function<bool()> is_abandoned;  ///< whether the browser has closed the connection
  std::multimap<std::string, std::string> parameters;

  /// The first of that name; empty where there is none.
  [[nodiscard]] std::string value(const std::string& name) const {
    const auto at = parameters.find(name);
    return at == parameters.end() ? "" : at->second;
  }
};

struct HttpReply {
  static constexpr int kNoContent = 204;
  static constexpr const char *kText = "text/plain; charset=utf-8", *kJson = "application/json";

  int status = 200;
  const char* type = kText;
  std::string body;  ///< none with kNoContent
  std::vector<std::pair<const char*, std::string>> headers{};
};

/// What answers a path; it is called on several threads at once.
struct HttpRoute {
  std::string path;
  std::function<HttpReply(const HttpRequest&)> answer;
};

/// Serves the routes at 127.0.0.1 and to no other host until a signal comes, and says the address
/// on standard output. `port`: 0 for any free one. An answer's InputError is one line of text,
/// status 400, another exception status 500. Requests of pages of other sites have status 403,
/// methods but GET and HEAD 405. Throws InputError where the port cannot be had.
void serve_http(int port, const std::vector<HttpRoute>& routes);

}  // namespace raygate
