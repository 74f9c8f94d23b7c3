#include "host/app/picture_server.h"

#include <civetweb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/app/built_in.h"
#include "host/app/console.h"
#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/app/outputs.h"
#include "host/base/input_error.h"
#include "host/film/display.h"
#include "host/render/renderer.h"

namespace raygate {
namespace {

constexpr std::int64_t kMostServedPixels = std::int64_t{1} << 24;
constexpr int kMostServedSamples = 1 << 16;

/// A request with the decoded parameters of its query.
struct Request {
  static constexpr int kMostParameters = 64;

  mg_connection* connection;
  const mg_request_info* info = mg_get_request_info(connection);
  std::vector<OptionValue> parameters{};  ///< at most one more than kMostParameters

  explicit Request(mg_connection* from) : connection(from) {
    std::string query = info->query_string == nullptr ? "" : info->query_string;
    mg_header fields[kMostParameters + 1];
    const int count = mg_split_form_urlencoded(query.data(), fields, kMostParameters + 1);
    for (int i = 0; i < count; ++i) {
      parameters.push_back({fields[i].name, fields[i].value == nullptr ? "" : fields[i].value});
    }
  }
  [[nodiscard]] std::string header(const char* name) const {
    const char* const text = mg_get_header(connection, name);
    return text == nullptr ? "" : text;
  }
  /// Returns the descriptor of the connection's socket, or -1; CivetWeb does not expose it.
  [[nodiscard]] int socket() const {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
      const int file = std::stoi(entry.path().filename());
      sockaddr_in peer{};
      socklen_t size = sizeof peer;
      if (::getpeername(file, reinterpret_cast<sockaddr*>(&peer), &size) == 0 &&
          peer.sin_family == AF_INET && ntohs(peer.sin_port) == info->remote_port) {
        return file;
      }
    }
    return -1;
  }
};

struct Reply {
  int status = 200;
  const char* type = "text/plain; charset=utf-8";
  std::string body;
  std::vector<std::pair<const char*, std::string>> headers{};

  void send(const Request& request) const {
    mg_connection* const to = request.connection;
    mg_response_header_start(to, status);
    mg_response_header_add(to, "Content-Type", type, -1);
    mg_response_header_add(to, "Content-Length", std::to_string(body.size()).c_str(), -1);
    mg_response_header_add(to, "Cache-Control", "no-store", -1);
    for (const auto& [name, value] : headers) {
      mg_response_header_add(to, name, value.c_str(), static_cast<int>(value.size()));
    }
    mg_response_header_send(to);
    if (request.info->request_method != std::string("HEAD")) {
      mg_write(to, body.data(), body.size());
    }
  }
};

/// Returns the command line of `options`, quoted for a shell.
std::string command_of(const Options& options) {
  std::vector<std::string> words{options.scene.string()};
  for (const auto& [name, text, where] : options.given) {
    if (where.empty()) words.push_back("--" + name + (text.empty() ? "" : "=" + text));
  }
  std::string command = "./render";
  for (const std::string& word : words) {
    const bool is_plain = word.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                              "-_=.,:/+^%@") == std::string::npos;
    command += is_plain ? " " : " '";
    for (const char c : word) command += c == '\'' ? std::string("'\\''") : std::string(1, c);
    if (!is_plain) command += '\'';
  }
  return command;
}

Json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

class PictureServer {
 public:
  PictureServer(const Options& options, const ServedScene& scene)
      : options_(options), scene_(scene) {
    erase(options_.given, {"serve", "port"});
  }

  void serve() {
    const std::string wanted = "127.0.0.1:" + std::to_string(options_.port);
    // Idle connections occupy a thread until the time limit.
    const char* settings[] = {
        "listening_ports",    wanted.c_str(), "num_threads", "64", "enable_keep_alive", "yes",
        "request_timeout_ms", "5000",         nullptr};
    const mg_callbacks none{};
    const std::unique_ptr<mg_context, void (*)(mg_context*)> server(
        mg_start(&none, nullptr, settings), mg_stop);
    mg_server_port bound{};
    if (!server || mg_get_server_ports(server.get(), 1, &bound) != 1) {
      throw InputError(
          "--port: found " + std::to_string(options_.port) +
          ", expected a port that no other program listens at, and room for 66 threads");
    }
    const std::string number = std::to_string(bound.port);
    names_ = {"127.0.0.1:" + number, "localhost:" + number};
    note_interruptions();
    mg_set_request_handler(server.get(), "/", handle, this);
    print("http://127.0.0.1:" + number + "/ shows the scene; Ctrl-C ends it\n");
    flush_standard_output();
    while (interruption() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

 private:
  static int handle(mg_connection* connection, void* server) {
    // Answers on another thread, because stacks of CivetWeb's threads (100 kB) are too small.
    const Request request(connection);
    Reply reply;
    try {
      const auto answer = &PictureServer::answer;
      auto* const self = static_cast<PictureServer*>(server);
      reply = std::async(std::launch::async, answer, self, std::cref(request)).get();
    } catch (const InputError& error) {
      reply = {.status = 400, .body = printable(error.what()) + "\n"};
    } catch (const std::exception& error) {
      reply = {.status = 500, .body = printable(error.what()) + "\n"};
    }
    reply.send(request);
    return reply.status;
  }

  [[nodiscard]] Reply answer(const Request& request) {
    const std::string method = request.info->request_method, path = request.info->local_uri;
    if (!is_own_page(request) || method != "GET") {
      return {.status = 403,
              .body =
                  "expected a GET of this server's page, to the host 127.0.0.1 or localhost, and "
                  "this port\n"};
    }
    if (request.parameters.size() > Request::kMostParameters) {
      throw InputError("found more than " + std::to_string(Request::kMostParameters) +
                       " parameters, expected fewer");
    }
    if (path == "/") return {.type = "text/html; charset=utf-8", .body = kPicturePage};
    if (path == "/picture") return picture(request);
    if (path == "/camera") return {.type = "application/json", .body = camera(request).dump()};
    return {.status = 404, .body = "expected /, /picture or /camera\n"};
  }

  [[nodiscard]] bool is_own_page(const Request& request) const {
    const std::string site = request.header("Sec-Fetch-Site"), origin = request.header("Origin");
    return names_.contains(request.header("Host")) &&
           (site.empty() || site == "same-origin" || site == "none") &&
           (origin.empty() || (origin.starts_with("http://") && names_.contains(origin.substr(7))));
  }

  static void erase(std::vector<OptionValue>& values, const std::set<std::string>& names) {
    std::erase_if(values, [&](const OptionValue& value) { return names.contains(value.name); });
  }

  /// Returns the server's options, overridden by those of the request.
  [[nodiscard]] Options options_of(const Request& request) const {
    std::vector<OptionValue> given = options_.given;
    std::set<std::string> replaced{"ground"};
    for (const OptionValue& value : request.parameters) {
      replaced.insert(value.name);
      if (value.name == "camera" || value.name == "view") replaced.insert({"camera", "view"});
    }
    erase(given, replaced);
    // By default, the camera decides whether there is a ground, but the served scene is fixed.
    given.push_back({"ground", scene_.has_ground ? "on" : "off"});
    Options options = with_values(options_, std::move(given), request.parameters);
    if (options.has_core() && scene_.prepared.bvh.has_instances()) {
      throw InputError("--unit core: expected --instances write with --serve");
    }
    if (std::int64_t{options.render.width} * options.render.height > kMostServedPixels) {
      throw InputError("--size: expected at most " + std::to_string(kMostServedPixels) +
                       " pixels with --serve");
    }
    if (options.render.samples > kMostServedSamples) {
      throw InputError("--spp: expected at most " + std::to_string(kMostServedSamples) +
                       " with --serve");
    }
    return options;
  }

  [[nodiscard]] Framing framing_of(const Options& options) const {
    const double aspect = static_cast<double>(options.render.width) / options.render.height;
    return frame_picture(options.camera, scene_.unframed, aspect);
  }

  Reply picture(const Request& request) {
    const Options options = options_of(request);
    const Framing framing = framing_of(options);
    const std::lock_guard<std::mutex> one_at_a_time(rendering_);
    const int socket = request.socket();
    RenderMonitor monitor;
    monitor.progress = [&](double /*fraction*/) {
      pollfd end{.fd = socket, .events = POLLRDHUP, .revents = 0};
      return interruption() == 0 && ::poll(&end, 1, 0) == 0;
    };
    const Bvh& bvh = scene_.prepared.bvh;
    if (!image_) image_ = make_memory_image(options, bvh);
    RenderStats stats;
    const Film film = render({scene_.prepared, framing.camera, options.render, framing.lights},
                             make_intersector_factory(options, bvh, image_), stats, monitor);
    if (stats.cancelled) return {.body = "cancelled\n"};
    const auto& channels = options.output.false_colors;
    const HitCounters& hit = stats.intersect.hit;
    const Json statistics{{"seconds", stats.wall_seconds},
                          {"rays", stats.rays},
                          {"tests", hit.tests},
                          {"doubts", hit.edge_doubts + hit.depth_doubts},
                          {"clocks", hit.clocks}};
    return {.type = "image/png",
            .body = encode_png(channels.empty() ? to_display(film, options.output.display)
                                                : false_color(film, channels.back().channel)),
            .headers = {{"X-Command", printable(command_of(options))},
                        {"X-Statistics", statistics.dump()}}};
  }

  [[nodiscard]] Json camera(const Request& request) const {
    const Options options = options_of(request);
    const Framing framing = framing_of(options);
    const Camera& camera = framing.camera;
    const glm::dvec3 eye = scene_.unframed.origin + glm::dvec3(camera.eye());
    Json json{{"eye", numbers(eye)},
              {"target", numbers(eye + camera.focus() * camera.forward())},
              {"up", numbers(camera.up())},
              {"fov", camera.vertical_fov_degrees()},
              {"width", options.render.width},
              {"height", options.render.height},
              {"samples", options.render.samples}};
    if (const auto& view = framing.request.angles) json["view"] = {view->first, view->second};
    return json;
  }

  Options options_;
  const ServedScene scene_;
  std::set<std::string> names_;  // the server's host names
  std::mutex rendering_;         // one picture at a time, with all threads
  std::shared_ptr<const MemoryImage> image_;
};

}  // namespace

void serve_pictures(const Options& options, const ServedScene& scene) {
  PictureServer(options, scene).serve();
}

}  // namespace raygate
