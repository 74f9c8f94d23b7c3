#include "host/app/http_server.h"

#include <civetweb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "host/app/option_table.h"
#include "host/app/process.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

std::string decoded(const std::string& text) {
  std::string result(text.size() + 1, '\0');
  const int size = mg_url_decode(text.data(), static_cast<int>(text.size()), result.data(),
                                 static_cast<int>(result.size()), 1);
  result.resize(static_cast<std::size_t>(std::max(0, size)));
  return result;
}

/// Returns the descriptor of the socket with this remote port, or -1; CivetWeb does not expose it.
int socket_from(int port) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int socket = std::stoi(entry.path().filename());
    sockaddr_in peer{};
    socklen_t size = sizeof peer;
    if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) == 0 &&
        peer.sin_family == AF_INET && ntohs(peer.sin_port) == port) {
      return socket;
    }
  }
  return -1;
}

HttpRequest request_of(mg_connection* connection) {
  HttpRequest request;
  request.is_abandoned = [socket = socket_from(mg_get_request_info(connection)->remote_port)] {
    pollfd end{.fd = socket, .events = POLLRDHUP, .revents = 0};
    return ::poll(&end, 1, 0) == 1;
  };
  const char* query = mg_get_request_info(connection)->query_string;
  std::istringstream words(query == nullptr ? "" : query);
  for (std::string word; std::getline(words, word, '&');) {
    const std::size_t equals = std::min(word.find('='), word.size());
    request.parameters.emplace(decoded(word.substr(0, equals)),
                               decoded(word.substr(std::min(equals + 1, word.size()))));
  }
  return request;
}

std::string method_of(mg_connection* connection) {
  return mg_get_request_info(connection)->request_method;
}

void send(mg_connection* connection, const HttpReply& reply) {
  mg_response_header_start(connection, reply.status);
  if (reply.status != HttpReply::kNoContent) {
    mg_response_header_add(connection, "Content-Type", reply.type, -1);
    mg_response_header_add(connection, "Content-Length", std::to_string(reply.body.size()).c_str(),
                           -1);
  }
  mg_response_header_add(connection, "Cache-Control", "no-store", -1);
  for (const auto& [name, value] : reply.headers) {
    mg_response_header_add(connection, name, value.c_str(), static_cast<int>(value.size()));
  }
  mg_response_header_send(connection);
  if (method_of(connection) != "HEAD") mg_write(connection, reply.body.data(), reply.body.size());
}

/// A route and the server's host names.
struct Handler {
  const HttpRoute& route;
  const std::set<std::string>& names;

  /// Returns the reply to a request that does not come from the server's own page, or none.
  [[nodiscard]] std::optional<HttpReply> refusal(mg_connection* connection) const {
    const auto header = [&](const char* name) -> std::string {
      const char* const value = mg_get_header(connection, name);
      return value == nullptr ? "" : value;
    };
    const std::string site = header("Sec-Fetch-Site"), origin = header("Origin");
    const bool is_own_page =
        (site.empty() || site == "same-origin" || site == "none") &&
        (origin.empty() || (origin.starts_with("http://") && names.contains(origin.substr(7))));
    if (!is_own_page || !names.contains(header("Host"))) {
      return HttpReply{.status = 403,
                       .body =
                           "expected a request of this server's page, to the host 127.0.0.1 or "
                           "localhost, and this port\n"};
    }
    const std::string method = method_of(connection);
    if (method == "GET" || method == "HEAD") return std::nullopt;
    return HttpReply{.status = 405,
                     .body = "found " + printable(method) + ", expected GET or HEAD\n",
                     .headers = {{"Allow", "GET, HEAD"}}};
  }

  [[nodiscard]] HttpReply answer(mg_connection* connection) const {
    try {
      if (auto refused = refusal(connection)) return *std::move(refused);
      return route.answer(request_of(connection));
    } catch (const InputError& error) {
      return {.status = 400, .body = printable(error.what()) + "\n"};
    } catch (const std::exception& error) {
      return {.status = 500, .body = printable(error.what()) + "\n"};
    }
  }
};

int handle(mg_connection* connection, void* handler) {
  // Another thread, because stacks of CivetWeb's threads (100 kB) are too small.
  HttpReply reply{.status = 503, .body = "found no thread that is free\n"};
  try {
    reply = std::async(std::launch::async, &Handler::answer, static_cast<const Handler*>(handler),
                       connection)
                .get();
  } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): the reply says so
  }
  send(connection, reply);
  return reply.status;
}

}  // namespace

void serve_http(int port, const std::vector<HttpRoute>& routes) {
  const std::string wanted = "127.0.0.1:" + std::to_string(port);
  // Idle connections occupy a thread until the time limit.
  const char* settings[] = {
      "listening_ports",    wanted.c_str(), "num_threads", "64", "enable_keep_alive", "yes",
      "request_timeout_ms", "5000",         nullptr};
  const mg_callbacks none{};
  std::set<std::string> names;
  std::vector<Handler> handlers;  // outlive the server
  const std::unique_ptr<mg_context, void (*)(mg_context*)> server(
      mg_start(&none, nullptr, settings), mg_stop);
  mg_server_port bound{};
  if (!server || mg_get_server_ports(server.get(), 1, &bound) != 1) {
    fail_value("--port", std::to_string(port),
               "a port that no other program listens at, and room for 66 threads");
  }
  const std::string number = std::to_string(bound.port);
  names = {"127.0.0.1:" + number, "localhost:" + number};
  note_interruptions();
  handlers.reserve(routes.size());
  for (const HttpRoute& route : routes) {
    handlers.push_back({route, names});
    // "$": only this path, not the paths below it.
    mg_set_request_handler(server.get(), (route.path + "$").c_str(), handle, &handlers.back());
  }
  print("http://127.0.0.1:" + number + "/ shows the scene; Ctrl-C ends it\n");
  flush_standard_output();
  while (interruption() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace raygate
