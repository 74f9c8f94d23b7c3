#include "host/cli/http_server.h"

#include <civetweb.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <set>
#include <sstream>
#include <thread>

#include "host/base/input_error.h"
#include "host/cli/process.h"
#include "host/options/option_text.h"

namespace raygate {
namespace {

std::string decoded(const std::string& text) {
  std::string result(text.size() + 1, '\0');
  const int size = mg_url_decode(text.data(), static_cast<int>(text.size()), result.data(),
                                 static_cast<int>(result.size()), 1);
  result.resize(static_cast<std::size_t>(std::max(0, size)));
  return result;
}

HttpRequest request_of(mg_connection* connection) {
  HttpRequest request;
  if (const char* host = mg_get_header(connection, "Host")) request.host = host;
  const char* query = mg_get_request_info(connection)->query_string;
  std::istringstream words(query == nullptr ? "" : query);
  for (std::string word; std::getline(words, word, '&');) {
    const std::size_t equals = std::min(word.find('='), word.size());
    request.parameters.emplace(decoded(word.substr(0, equals)),
                               decoded(word.substr(std::min(equals + 1, word.size()))));
  }
  return request;
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
  mg_write(connection, reply.body.data(), reply.body.size());
}

/// A route, and the names that the server goes by.
struct Handler {
  const HttpRoute& route;
  const std::set<std::string>& names;

  [[nodiscard]] HttpReply answer(mg_connection* connection) const {
    try {
      const HttpRequest request = request_of(connection);
      if (!names.contains(request.host)) {
        return {.status = 403, .body = "expected the host 127.0.0.1 or localhost, and this port\n"};
      }
      return route.answer(request);
    } catch (const InputError& error) {
      return {.status = 400, .body = printable(error.what()) + "\n"};
    } catch (const std::exception& error) {
      return {.status = 500, .body = printable(error.what()) + "\n"};
    }
  }
};

int handle(mg_connection* connection, void* handler) {
  // The library's threads have stacks of 100 kB, which parsing a command line nearly fills.
  const HttpReply reply = std::async(std::launch::async, &Handler::answer,
                                     static_cast<const Handler*>(handler), connection)
                              .get();
  send(connection, reply);
  return reply.status;
}

}  // namespace

void serve_http(int port, const std::vector<HttpRoute>& routes) {
  const std::string wanted = "127.0.0.1:" + std::to_string(port);
  const char* settings[] = {"listening_ports",   wanted.c_str(), "num_threads", "8",
                            "enable_keep_alive", "yes",          nullptr};
  const mg_callbacks none{};
  std::set<std::string> names;
  std::vector<Handler> handlers;  // outlive the server, which ends with its last answer
  const std::unique_ptr<mg_context, void (*)(mg_context*)> server(
      mg_start(&none, nullptr, settings), mg_stop);
  mg_server_port bound{};
  if (!server || mg_get_server_ports(server.get(), 1, &bound) != 1) {
    fail_value("--port", std::to_string(port), "a port that no other program listens at");
  }
  const std::string number = std::to_string(bound.port);
  names = {"127.0.0.1:" + number, "localhost:" + number};
  note_interruptions();
  handlers.reserve(routes.size());
  for (const HttpRoute& route : routes) {
    handlers.push_back({route, names});
    // "$": the path alone, and nothing below it.
    mg_set_request_handler(server.get(), (route.path + "$").c_str(), handle, &handlers.back());
  }
  print("http://127.0.0.1:" + number + "/ shows the scene; Ctrl-C ends it\n");
  flush_standard_output();
  while (interruption() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace raygate
