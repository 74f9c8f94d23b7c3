#include "host/app/picture_server.h"

#include <civetweb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/app/load.h"
#include "host/app/picture_page.h"
#include "host/app/process.h"
#include "host/base/input_error.h"
#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/render/renderer.h"

namespace raygate {
namespace {

constexpr std::int64_t kMostServedPixels = std::int64_t{1} << 24;
constexpr int kMostServedSamples = 1 << 16;

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

/// A request with the decoded parameters of its query.
struct Request {
  mg_connection* connection;
  std::string path;
  std::multimap<std::string, std::string> parameters;
  int socket;

  explicit Request(mg_connection* from)
      : connection(from),
        path(mg_get_request_info(from)->local_uri),
        socket(socket_from(mg_get_request_info(from)->remote_port)) {
    const char* query = mg_get_request_info(from)->query_string;
    std::istringstream words(query == nullptr ? "" : query);
    for (std::string word; std::getline(words, word, '&');) {
      const auto [name, text] = split_at_equals(word);
      parameters.emplace(decoded(name), decoded(text));
    }
  }
  /// Returns the first value of a name, or "".
  [[nodiscard]] std::string value(const std::string& name) const {
    const auto at = parameters.find(name);
    return at == parameters.end() ? "" : at->second;
  }
  [[nodiscard]] std::string header(const char* name) const {
    const char* const text = mg_get_header(connection, name);
    return text == nullptr ? "" : text;
  }
  [[nodiscard]] std::string method() const {
    return mg_get_request_info(connection)->request_method;
  }
  /// Whether the browser has closed the connection.
  [[nodiscard]] bool is_abandoned() const {
    pollfd end{.fd = socket, .events = POLLRDHUP, .revents = 0};
    return ::poll(&end, 1, 0) == 1;
  }
};

struct Reply {
  static constexpr int kNoContent = 204;
  static constexpr const char *kText = "text/plain; charset=utf-8", *kJson = "application/json";

  int status = 200;
  const char* type = kText;
  std::string body;  ///< empty with kNoContent
  std::vector<std::pair<const char*, std::string>> headers{};

  void send(const Request& request) const {
    mg_connection* const to = request.connection;
    mg_response_header_start(to, status);
    if (status != kNoContent) {
      mg_response_header_add(to, "Content-Type", type, -1);
      mg_response_header_add(to, "Content-Length", std::to_string(body.size()).c_str(), -1);
    }
    mg_response_header_add(to, "Cache-Control", "no-store", -1);
    for (const auto& [name, value] : headers) {
      mg_response_header_add(to, name, value.c_str(), static_cast<int>(value.size()));
    }
    mg_response_header_send(to);
    if (request.method() != "HEAD") mg_write(to, body.data(), body.size());
  }
};

/// Returns a word quoted for a shell.
std::string quoted(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("-_=.,:/+^%@", c) != nullptr;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

Json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// The command line of a request.
struct Command {
  std::vector<std::string> words;
  Options options;

  [[nodiscard]] std::string text() const {
    std::string text = "./render";
    for (const std::string& word : words) text.append(" ").append(quoted(word));
    return text;
  }
};

class PictureServer {
 public:
  PictureServer(const Options& options, const ServedScene& scene)
      : options_(options), scene_(scene) {
    words_ = options.words;
    std::erase(words_, "--serve");
    erase_option("port");
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
      fail_value("--port", std::to_string(options_.port),
                 "a port that no other program listens at, and room for 66 threads");
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
    // Another thread, because stacks of CivetWeb's threads (100 kB) are too small.
    const Request request(connection);
    Reply reply{.status = 503, .body = "found no thread that is free\n"};
    try {
      const auto answer = &PictureServer::answer;
      auto* const self = static_cast<PictureServer*>(server);
      reply = std::async(std::launch::async, answer, self, std::cref(request)).get();
    } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): the reply says so
    }
    reply.send(request);
    return reply.status;
  }

  [[nodiscard]] Reply answer(const Request& request) {
    try {
      if (auto refused = refusal(request)) return *std::move(refused);
      if (request.path == "/") return {.type = "text/html; charset=utf-8", .body = kPicturePage};
      if (request.path == "/picture") return picture(request);
      if (request.path == "/camera") return camera(request);
      if (request.path == "/pixel") return pixel(request);
      return {.status = 404, .body = "expected /, /picture, /camera or /pixel\n"};
    } catch (const InputError& error) {
      return {.status = 400, .body = printable(error.what()) + "\n"};
    } catch (const std::exception& error) {
      return {.status = 500, .body = printable(error.what()) + "\n"};
    }
  }

  /// Returns the reply to a request that does not come from the server's own page, or none.
  [[nodiscard]] std::optional<Reply> refusal(const Request& request) const {
    const std::string site = request.header("Sec-Fetch-Site"), origin = request.header("Origin");
    const bool is_own_page =
        (site.empty() || site == "same-origin" || site == "none") &&
        (origin.empty() || (origin.starts_with("http://") && names_.contains(origin.substr(7))));
    if (!is_own_page || !names_.contains(request.header("Host"))) {
      return Reply{.status = 403,
                   .body =
                       "expected a request of this server's page, to the host 127.0.0.1 or "
                       "localhost, and this port\n"};
    }
    const std::string method = request.method();
    if (method == "GET" || method == "HEAD") return std::nullopt;
    return Reply{.status = 405,
                 .body = "found " + printable(method) + ", expected GET or HEAD\n",
                 .headers = {{"Allow", "GET, HEAD"}}};
  }

  /// Returns the server's command line with the options of the request.
  [[nodiscard]] Command command_of(const Request& request) const {
    Command command{words_, {}};
    if (request.parameters.contains("camera") || request.parameters.contains("view")) {
      erase_option(command.words, "camera");
      erase_option(command.words, "view");
    }
    for (const auto& [name, value] : request.parameters) {
      if (name == "slot" || name == "turn" || name == "x" || name == "y") continue;
      require_page_option(name);
      erase_option(command.words, name);
      command.words.push_back(std::string("--").append(name).append("=").append(value));
    }
    // The default depends on the camera, but the scene is built.
    erase_option(command.words, "ground");
    command.words.push_back(std::string("--ground=") + (scene_.has_ground ? "on" : "off"));
    command.options = with_words(options_, command.words);
    const RenderSettings& render = command.options.render;
    if (std::int64_t{render.width} * render.height > kMostServedPixels) {
      throw InputError("--size: expected at most " + std::to_string(kMostServedPixels) +
                       " pixels beside --serve");
    }
    if (render.samples > kMostServedSamples) {
      throw InputError("--spp: expected at most " + std::to_string(kMostServedSamples) +
                       " beside --serve");
    }
    if (command.options.has_core() && scene_.prepared.bvh.has_instances()) {
      throw InputError("--unit core: expected --instances write beside --serve");
    }
    return command;
  }

  void erase_option(const std::string& name) { erase_option(words_, name); }
  static void erase_option(std::vector<std::string>& words, const std::string& name) {
    const std::string dashed = std::string("--").append(name);
    for (auto at = words.begin(); at != words.end();) {
      if (*at == dashed && at + 1 != words.end()) {
        at = words.erase(at, at + 2);
      } else if (at->starts_with(dashed + "=")) {
        at = words.erase(at);
      } else {
        ++at;
      }
    }
  }

  [[nodiscard]] Framing framing_of(const Options& options) const {
    const double aspect = static_cast<double>(options.render.width) / options.render.height;
    return frame_picture(options.camera, scene_.unframed, aspect);
  }

  [[nodiscard]] IntersectorFactory intersectors_of(const Options& options) {
    prepare_engine(options);
    if (options.has_core() && !image_) {
      image_ = make_memory_image(options, scene_.prepared.bvh);
    }
    return make_intersector_factory(options, scene_.prepared.bvh, options.render.skips, image_);
  }

  Reply picture(const Request& request) {
    const std::string slot = request.value("slot");
    const std::uint64_t turn = slot.empty() ? 0 : take_turn(slot, request.value("turn"));
    const Command command = command_of(request);
    const Options& options = command.options;
    const Framing framing = framing_of(options);
    const std::lock_guard<std::mutex> one_at_a_time(rendering_);
    RenderMonitor monitor;
    monitor.progress = [&](double /*fraction*/) {
      return interruption() == 0 && is_current(slot, turn) && !request.is_abandoned();
    };
    RenderStats stats;
    if (monitor.progress(0.0)) {
      const Film film = render({scene_.prepared, framing.camera, options.render, framing.lights},
                               intersectors_of(options), stats, monitor);
      if (!stats.cancelled) {
        return {.type = "image/png",
                .body = encode_png(shown(film, options.output)),
                .headers = {{"X-Command", printable(command.text())},
                            {"X-Statistics", text_of(stats)}}};
      }
    }
    return {.status = Reply::kNoContent, .body = {}};
  }

  /// Returns the picture, or its last false-colour channel if there is one.
  static Image8 shown(const Film& film, const OutputOptions& output) {
    if (output.false_colors.empty()) return to_display(film, output.display);
    const FalseColorOutput& wanted = output.false_colors.back();
    const std::vector<Channel> channels = channels_of(film);
    const auto channel = std::ranges::find(channels, wanted.channel, &Channel::name);
    if (channel == channels.end()) throw InputError("found no channel " + wanted.channel);
    return false_color(film.width, film.height, film.window, *channel, wanted.scale);
  }

  static std::string text_of(const RenderStats& stats) {
    const HitCounters& hit = stats.intersect.hit;
    return Json{{"seconds", stats.wall_seconds},
                {"rays", stats.rays},
                {"tests", hit.tests},
                {"doubts", hit.edge_doubts + hit.depth_doubts},
                {"clocks", hit.clocks}}
        .dump();
  }

  Reply camera(const Request& request) {
    const Options options = command_of(request).options;
    const Framing framing = framing_of(options);
    const Camera& camera = framing.camera;
    const glm::dvec3 eye = scene_.unframed.origin + glm::dvec3(camera.eye());
    Json json{{"eye", numbers(eye)},
              {"target", numbers(eye + camera.focus() * camera.forward())},
              {"right", numbers(camera.right())},
              {"up", numbers(camera.up())},
              {"fov", camera.vertical_fov_degrees()},
              {"width", options.render.width},
              {"height", options.render.height},
              {"samples", options.render.samples},
              {"variants", Json::array()}};
    for (const Variant& variant : all_variants_of_arithmetic()) {
      json["variants"].push_back(variant.name);
    }
    for (const auto& [name, value] : framing.options) {
      if (name == "view") json["view"] = Json::parse("[" + value + "]");
    }
    return {.type = Reply::kJson, .body = json.dump()};
  }

  Reply pixel(const Request& request) {
    const Command command = command_of(request);
    const Options& options = command.options;
    const glm::ivec2 size{options.render.width, options.render.height};
    const auto coordinate = [&](const char* name, int end) {
      const std::string text = request.value(name);
      const auto number = parse_number<int>(text);
      if (!number || *number < 0 || *number >= end) {
        fail_value(name, text,
                   "a pixel of " + std::to_string(size.x) + "x" + std::to_string(size.y));
      }
      return *number;
    };
    const int x = coordinate("x", size.x), y = coordinate("y", size.y);
    const Ray ray = framing_of(options).camera.ray((x + 0.5) / size.x, (y + 0.5) / size.y, {});
    const std::lock_guard<std::mutex> one_at_a_time(rendering_);
    const Bvh& bvh = scene_.prepared.bvh;
    Json json{{"pixel", {x, y}},
              {"origin", words(ray.origin)},
              {"direction", words(ray.direction)},
              {"engine", found(ray, *intersectors_of(options)())},
              {"cpu", found(ray, CpuIntersector(bvh))}};
    return {.type = Reply::kJson, .body = json.dump()};
  }

  /// Returns a vector in decimal and as binary32 words.
  static Json words(const glm::vec3& v) {
    const std::array<float, 3> coordinates{v.x, v.y, v.z};
    return {{"decimal", coordinates}, {"words", hex_words(coordinates).substr(1)}};
  }

  /// Returns the hit and the statistics of one ray.
  [[nodiscard]] Json found(const Ray& ray, Intersector&& intersector) const {
    return found(ray, intersector);
  }
  [[nodiscard]] Json found(const Ray& ray, Intersector& intersector) const {
    NearestHit hit;
    intersector.intersect({&ray, 1}, {}, {&hit, 1});
    const HitCounters counters = intersector.counters().hit;
    Json json{{"tests", counters.tests},
              {"doubts", counters.edge_doubts + counters.depth_doubts},
              {"clocks", counters.clocks}};
    if (hit.primitive == NearestHit::kNone) return json;
    const Bvh& bvh = scene_.prepared.bvh;
    json["triangle"] = bvh.triangle_of(hit.primitive);
    json["t"] = {hit.t.low, hit.t.high};
    json["P"] = words(hit.point);
    if (std::isfinite(hit.point_error)) json["error of P"] = hit.point_error;
    json["corners"] = Json::array();
    for (const glm::vec3& corner : bvh.corners_of(hit.primitive)) {
      json["corners"].push_back(words(corner));
    }
    return json;
  }

  /// Returns the number of a slot's request. Requests may arrive out of order.
  std::uint64_t take_turn(const std::string& slot, const std::string& number) {
    const auto turn = parse_number<std::uint64_t>(number);
    if (!turn) fail_value("turn", number, "the number of the slot's request");
    const std::lock_guard<std::mutex> lock(turns_mutex_);
    std::uint64_t& newest = turns_[slot];
    newest = std::max(newest, *turn);
    return *turn;
  }
  [[nodiscard]] bool is_current(const std::string& slot, std::uint64_t turn) {
    if (slot.empty()) return true;
    const std::lock_guard<std::mutex> lock(turns_mutex_);
    return turns_[slot] == turn;
  }

  const Options& options_;
  const ServedScene scene_;
  std::set<std::string> names_;     // the server's host names
  std::vector<std::string> words_;  // the command line without --serve and --port
  std::mutex rendering_;            // one picture at a time, with all threads
  std::shared_ptr<const MemoryImage> image_;
  std::mutex turns_mutex_;
  std::map<std::string, std::uint64_t> turns_;  // newest request by slot
};

}  // namespace

void serve_pictures(const Options& options, const ServedScene& scene) {
  PictureServer(options, scene).serve();
}

}  // namespace raygate
