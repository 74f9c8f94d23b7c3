#include "host/app/picture_server.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/app/framing.h"
#include "host/app/http_server.h"
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
    serve_http(options_.port,
               {{"/", [](const HttpRequest&) { return page(); }},
                {"/picture", [this](const HttpRequest& request) { return picture(request); }},
                {"/camera", [this](const HttpRequest& request) { return camera(request); }},
                {"/pixel", [this](const HttpRequest& request) { return pixel(request); }}});
  }

 private:
  /// Returns the server's command line with the options of the request.
  [[nodiscard]] Command command_of(const HttpRequest& request) const {
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

  static HttpReply page() { return {.type = "text/html; charset=utf-8", .body = kPicturePage}; }

  HttpReply picture(const HttpRequest& request) {
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
    return {.status = HttpReply::kNoContent, .body = {}};
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

  HttpReply camera(const HttpRequest& request) {
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
    return {.type = HttpReply::kJson, .body = json.dump()};
  }

  HttpReply pixel(const HttpRequest& request) {
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
    return {.type = HttpReply::kJson, .body = json.dump()};
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
