#include "host/cli/report.h"

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
  std::string line = options.scene.filename().string() + ": " +
                     plural(report.triangles, "triangle") + ", " + std::to_string(options.width) +
                     "x" + std::to_string(options.height);
  if (options.window.width() != options.width || options.window.height() != options.height) {
    line += " cropped to " + std::to_string(options.window.width()) + "x" +
            std::to_string(options.window.height());
  }
  line += ", engine " + to_string(options.engine);
  line += ", unit " + options.unit;
  if (options.unit == "pipeline" && options.lanes > 1) {
    line += " of " + std::to_string(options.lanes) + " lanes";
  }
  return line + ", " + plural(options.threads, "thread");
}

/// "hit tests 80 %, boxes 15 %, ...": of the time of all threads.
std::string shares(const RenderStats& render) {
  const std::pair<const char*, double> parts[] = {{"hit tests", render.hit_seconds},
                                                  {"boxes", render.traverse_seconds},
                                                  {"doubts", render.doubt_seconds},
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
  const HitCounters& hit = report.render.hit;
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

}  // namespace

double clocks_per_test(const HitCounters& counters) {
  return ratio(static_cast<double>(counters.clocks), static_cast<double>(counters.unit_tests));
}

std::string to_text(const Report& report) {
  const RenderStats& render = report.render;
  const HitCounters& hit = render.hit;
  Table table;
  table.add("rays", render.rays);
  table.add(
      "tests", hit.tests,
      format_fixed(ratio(static_cast<double>(hit.tests), static_cast<double>(render.rays)), 2) +
          " for each ray");
  table.add("hits", hit.hits);
  table.add("doubts", hit.edge_doubts + hit.depth_doubts, "settled by exact arithmetic");
  table.add("unit", hit.unit_tests, "tests that went through the unit");
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
  return headline(report) + "\n" + table.text();
}

std::string to_json(const Report& report) {
  using nlohmann::ordered_json;
  const Options& options = report.options;
  const RenderStats& render = report.render;
  const HitCounters& hit = render.hit;
  const PixelRect& window = options.window;
  ordered_json pictures = ordered_json::array();
  for (const auto& path : report.pictures) pictures.push_back(path.string());
  const ordered_json json = {
      {"software", kSoftware},
      {"scene", options.scene.string()},
      {"triangles", report.triangles},
      {"width", options.width},
      {"height", options.height},
      {"window", {window.x0, window.y0, window.x1, window.y1}},
      {"engine", to_string(options.engine)},
      {"unit", options.unit},
      {"lanes", options.lanes},
      {"threads", options.threads},
      {"seed", options.seed},
      {"pictures", pictures},
      {"rays", render.rays},
      {"records", render.records},
      {"tests", hit.tests},
      {"misses", hit.misses},
      {"hits", hit.hits},
      {"edge_doubts", hit.edge_doubts},
      {"depth_doubts", hit.depth_doubts},
      {"exact_inside", render.exact_inside},
      {"exact_depth", render.exact_depth},
      {"plane_tests", hit.plane_tests},
      {"unit_tests", hit.unit_tests},
      {"quotients", hit.quotients},
      {"clocks", hit.clocks},
      {"idle_clocks", hit.idle_clocks},
      {"output_stalls", hit.output_stalls},
      {"clocks_per_test", clocks_per_test(hit)},
      {"seconds",
       {{"load", report.load_seconds},
        {"tree", report.tree_seconds},
        {"render", render.wall_seconds},
        {"write", report.write_seconds},
        {"total", report.total_seconds}}},
      {"thread_seconds",
       {{"boxes", render.traverse_seconds},
        {"hit_tests", render.hit_seconds},
        {"doubts", render.doubt_seconds},
        {"shading", render.shade_seconds}}},
  };
  // File names need not be UTF-8, JSON must be.
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace raygate
