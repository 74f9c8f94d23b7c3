// HTTP server for a browser on this machine.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace raygate {

/// A request with the decoded parameters of its query.
struct HttpRequest {
  std::function<bool()> is_abandoned;  ///< whether the browser has closed the connection
  std::multimap<std::string, std::string> parameters;

  /// Returns the first value of a name, or "".
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
  std::string body;  ///< empty with kNoContent
  std::vector<std::pair<const char*, std::string>> headers{};
};

/// A path and the function that answers it, called on several threads at once.
struct HttpRoute {
  std::string path;
  std::function<HttpReply(const HttpRequest&)> answer;
};

/// Serves the routes at 127.0.0.1 until a signal comes, and prints the address on standard output.
/// `port`: 0 for any free port. InputError becomes one line of text with status 400, other
/// exceptions status 500. Requests from pages of other sites get status 403, methods other than GET
/// and HEAD 405. Throws InputError if the port is not available.
void serve_http(int port, const std::vector<HttpRoute>& routes);

}  // namespace raygate
