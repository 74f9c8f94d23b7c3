#include "host/cli/report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/cli/format.h"
#include "host/cli/version.h"

namespace raygate {
namespace {

/// Lines of a name, a right-aligned count and a remark.
class Table {
 public:
  void add(const std::string& name, std::uint64_t count, const std::string& remark = "") {
    std::string number = format_count(count);
    number.insert(0, number.size() < 15 ? 15 - number.size() : 0, ' ');
    add(name, number + (remark.empty() ? "" : "  " + remark));
  }
  void add(std::string name, const std::string& value) {
    name.resize(8, ' ');
    text_ += name + value + "\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

std::string plural(std::uint64_t count, const std::string& noun) {
  return format_count(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string headline(const Report& report) {
  const Options& options = report.options;
  std::string line = options.obj().filename().string() + ": " +
                     plural(report.triangles, "triangle") + ", " + std::to_string(options.width) +
                     "x" + std::to_string(options.height);
  if (options.window.width() != options.width || options.window.height() != options.height) {
    line += " cropped to " + std::to_string(options.window.width()) + "x" +
            std::to_string(options.window.height());
  }
  line += ", engine " + to_string(options.engine);
  if (options.engine == Engine::kCpu) return line + ", " + plural(options.threads, "thread");
  line += ", unit " + options.unit;
  if (options.engine != Engine::kModel) line += " (" + to_string(options.arith) + ")";
  if (options.unit == "pipeline" && options.lanes > 1) {
    line += " of " + std::to_string(options.lanes) + " lanes";
  }
  return line + ", " + plural(options.threads, "thread");
}

/// "hit tests 80 %, boxes 15 %, ...": of the time of all threads.
std::string shares(const RenderStats& render) {
  const std::pair<const char*, double> parts[] = {
      {"hit tests", render.find.hit_tests},
      {"boxes", render.find.traverse},
      {"records", render.find.record},
      {"shading", render.shade_seconds}};
  double sum = 0.0;
  for (const auto& [name, seconds] : parts) sum += seconds;
  std::string text;
  for (const auto& [name, seconds] : parts) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            format_fixed(100.0 * ratio(seconds, sum), 1) + " %";
  }
  return text;
}

/// "a test 98.2 %, idle 1.8 %, ...": what the lanes of the pipelined unit did with their clocks.
std::string lane_clocks(const Report& report) {
  const HitCounters& hit = report.render.find.hit;
  const double all = static_cast<double>(hit.clocks) * report.options.lanes;
  const std::pair<const char*, std::uint64_t> parts[] = {{"a test", hit.unit_tests},
                                                         {"idle", hit.idle_clocks},
                                                         {"results not taken", hit.output_stalls}};
  std::string text;
  for (const auto& [name, clocks] : parts) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            format_fixed(100.0 * ratio(static_cast<double>(clocks), all), 1) + " %";
  }
  return text;
}

/// What was left out, and about what it would have cost: by the mean cost of what was done.
std::string skips(const Report& report) {
  const RenderStats& render = report.render;
  const SkipCounters& skipped = render.skipped;
  const auto rays = static_cast<double>(render.rays), tests = static_cast<double>(render.find.hit.tests);
  const double ray_seconds =
      ratio(render.find.traverse + render.find.record + render.shade_seconds, rays);
  const double test_seconds = ratio(render.find.hit_tests, tests);
  std::string text =
      "not done, for the picture does not need it (see --no-skip; costs as of what was):\n";
  const auto add = [&](std::uint64_t count, const char* what, double saved_tests, double seconds) {
    if (count == 0) return;
    std::string number = format_count(count);
    number.insert(0, number.size() < 23 ? 23 - number.size() : 0, ' ');
    text += number + "  " + what;
    if (saved_tests > 0.0) {
      text += ": " + format_count(static_cast<std::uint64_t>(saved_tests)) + " tests";
    }
    if (seconds > 0.0) text += (saved_tests > 0.0 ? ", " : ": ") + format_duration(seconds);
    text += '\n';
  };
  const auto rays_left_out = [&](std::uint64_t count, const char* what) {
    const auto number = static_cast<double>(count);
    const double saved = number * ratio(tests, rays);
    add(count, what, saved, number * ray_seconds + saved * test_seconds);
  };
  add(skipped.culled_tests, "tests of rays against polygons in boxes off their way", 0.0,
      static_cast<double>(skipped.culled_tests) * test_seconds);
  add(skipped.records, "records of polygons that no ray of their origin came near", 0.0, 0.0);
  rays_left_out(skipped.lights_behind, "shadow rays to lights that bring nothing");
  rays_left_out(skipped.weightless, "reflected and refracted rays that bring nothing");
  rays_left_out(skipped.dim, "reflected and refracted rays below --threshold");
  rays_left_out(skipped.empty_tile_rays, "camera rays where there is nothing");
  add(skipped.first_occluders, "shadow rays' ways beyond the first occluder found", 0.0, 0.0);
  if (render.find.hit.unit_tests != 0 &&
      (report.options.unit == "pipeline" || report.options.light.skips.divisions)) {
    const std::uint64_t all = 3 * render.find.hit.tests;
    add(all - std::min(all, render.find.hit.quotients), "divisions of the paper's three for each test",
        0.0, 0.0);
  }
  return text;
}

}  // namespace

double clocks_per_test(const HitCounters& counters) {
  return ratio(static_cast<double>(counters.clocks), static_cast<double>(counters.unit_tests));
}

std::string to_text(const Report& report) {
  const RenderStats& render = report.render;
  const HitCounters& hit = render.find.hit;
  Table table;
  table.add("rays", render.rays,
            format_count(render.camera_rays) + " from the camera, " +
                format_count(render.shadow_rays) + " to lights, " +
                format_count(render.rays - render.camera_rays - render.shadow_rays) + " others");
  table.add(
      "tests", hit.tests,
      format_fixed(ratio(static_cast<double>(hit.tests), static_cast<double>(render.rays)), 2) +
          " for each ray");
  table.add("hits", hit.hits);
  table.add("doubts", hit.edge_doubts + hit.depth_doubts, "settled by exact arithmetic");
  if (hit.unit_tests > 0) table.add("unit", hit.unit_tests, "tests that went through the unit");
  if (hit.clocks > 0) {
    table.add("clocks", hit.clocks,
              format_fixed(clocks_per_test(hit), 2) + " for each test of the unit");
    if (report.options.unit == "pipeline") table.add("lanes", lane_clocks(report));
  }
  table.add("time", format_duration(report.total_seconds) + ": load " +
                        format_duration(report.load_seconds) + ", tree " +
                        format_duration(report.tree_seconds) + ", render " +
                        format_duration(render.wall_seconds) + ", write " +
                        format_duration(report.write_seconds));
  table.add("render", shares(render));
  std::string pictures;
  for (const auto& path : report.pictures) {
    pictures += (pictures.empty() ? "" : ", ") + path.string();
  }
  table.add("wrote", pictures);
  for (const std::string& legend : report.legends) table.add("scale", legend);
  return headline(report) + "\n" + table.text() + skips(report);
}

std::string to_json(const Report& report) {
  using nlohmann::ordered_json;
  const Options& options = report.options;
  const RenderStats& render = report.render;
  const HitCounters& hit = render.find.hit;
  const PixelRect& window = options.window;
  ordered_json pictures = ordered_json::array();
  for (const auto& path : report.pictures) pictures.push_back(path.string());
  const ordered_json json = {
      {"software", kSoftware},
      {"scene", options.obj().string()},
      {"triangles", report.triangles},
      {"width", options.width},
      {"height", options.height},
      {"window", {window.x0, window.y0, window.x1, window.y1}},
      {"engine", to_string(options.engine)},
      {"unit", options.unit},
      {"arith", to_string(options.arith)},
      {"lanes", options.lanes},
      {"threads", options.threads},
      {"seed", options.seed},
      {"pictures", pictures},
      {"integrator", to_string(options.light.integrator)},
      {"spp", options.light.samples},
      {"depth", options.light.max_depth()},
      {"rays", render.rays},
      {"camera_rays", render.camera_rays},
      {"shadow_rays", render.shadow_rays},
      {"records", render.find.own_records + render.find.common_records},
      {"common_records", render.find.common_records},
      {"tests", hit.tests},
      {"misses", hit.misses},
      {"hits", hit.hits},
      {"edge_doubts", hit.edge_doubts},
      {"depth_doubts", hit.depth_doubts},
      {"exact_inside", render.find.exact_inside},
      {"exact_depth", render.find.exact_depth},
      {"point_doubts", render.point_doubts},
      {"plane_tests", hit.plane_tests},
      {"unit_tests", hit.unit_tests},
      {"quotients", hit.quotients},
      {"input_bytes", hit.input_bytes},
      {"clocks", hit.clocks},
      {"idle_clocks", hit.idle_clocks},
      {"output_stalls", hit.output_stalls},
      {"clocks_per_test", clocks_per_test(hit)},
      {"skipped",
       {{"culled_tests", render.skipped.culled_tests},
        {"records", render.skipped.records},
        {"lights_behind", render.skipped.lights_behind},
        {"weightless", render.skipped.weightless},
        {"dim", render.skipped.dim},
        {"empty_tile_rays", render.skipped.empty_tile_rays},
        {"first_occluders", render.skipped.first_occluders}}},
      {"seconds",
       {{"load", report.load_seconds},
        {"tree", report.tree_seconds},
        {"render", render.wall_seconds},
        {"write", report.write_seconds},
        {"total", report.total_seconds}}},
      {"thread_seconds",
       {{"boxes", render.find.traverse},
        {"records", render.find.record},
        {"hit_tests", render.find.hit_tests},
        {"shading", render.shade_seconds}}},
  };
  // File names need not be UTF-8, JSON must be.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace raygate
