#include "host/app/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "host/app/console.h"
#include "host/app/process.h"
#include "host/app/version.h"

namespace raygate {
namespace {

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

/// Returns a line of the summary: the name, padded, and the value.
std::string row(std::string name, const std::string& value) {
  name.resize(9, ' ');
  return name + value + "\n";
}

/// Returns "1,234 rays/s".
std::string rate(std::uint64_t count, double seconds, const char* of_what) {
  const double per_second = ratio(static_cast<double>(count), seconds);
  return format_count(static_cast<std::uint64_t>(per_second)) + " " + of_what + "/s";
}

std::string headline(const Report& report) {
  const Options& options = report.options;
  std::string line = printable(options.scene_file.obj.filename().string()) + ": " +
                     format_count(report.triangles, "triangle") + ", " +
                     std::to_string(options.render.width) + "x" +
                     std::to_string(options.render.height);
  if (options.render.window.width() != options.render.width ||
      options.render.window.height() != options.render.height) {
    line += " cropped to " + std::to_string(options.render.window.width()) + "x" +
            std::to_string(options.render.window.height());
  }
  line += ", engine " + to_string(options.engine);
  if (options.engine != Engine::kCpu) {
    line += " (" + options.unit;
    if (options.variant) line += ", " + options.variant->name;
    if (options.engine != Engine::kModel) line += ", " + to_string(options.arith);
    if (options.lanes > 1) line += ", " + std::to_string(options.lanes) + " lanes";
    if (options.cores > 1) line += ", " + std::to_string(options.cores) + " cores";
    line += ')';
  }
  return line + ", " + format_count(options.threads, "thread") + "\n";
}

/// Returns the fractions of the threads' time: "hit tests 80 %, boxes 15 %, ...".
std::string shares(const RenderStats& render) {
  const std::pair<const char*, double> parts[] = {{"hit tests", render.intersect.hit_tests},
                                                  {"boxes", render.intersect.traverse},
                                                  {"records", render.intersect.record},
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

/// Returns how the lanes of the pipelined unit spent their clocks: "testing 98.2 %, no input 1.8
/// %".
std::string lane_clocks(const Report& report) {
  const HitCounters& hit = report.render.intersect.hit;
  const double all = static_cast<double>(hit.clocks) * report.options.lanes;
  const std::pair<const char*, std::uint64_t> parts[] = {
      {"testing", hit.unit_tests},
      {"no input", hit.idle_clocks},
      {"stalled by the consumer", hit.output_stalls}};
  std::string text;
  for (const auto& [name, clocks] : parts) {
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            format_fixed(100.0 * ratio(static_cast<double>(clocks), all), 1) + " %";
  }
  return text;
}

/// Skipped work of one kind and its estimated cost, from the mean cost of the work done; 0:
/// unknown.
struct Skipped {
  std::uint64_t count;
  const char* what;
  double tests, seconds;
};

std::vector<Skipped> skipped(const Report& report) {
  const RenderStats& render = report.render;
  const SkipCounters& counts = render.skipped;
  const auto rays = static_cast<double>(render.rays),
             tests = static_cast<double>(render.intersect.hit.tests);
  const double ray_seconds =
      ratio(render.intersect.traverse + render.intersect.record + render.shade_seconds, rays);
  const double test_seconds = ratio(render.intersect.hit_tests, tests);
  const auto of_rays = [&](std::uint64_t count, const char* what) {
    const double saved = static_cast<double>(count) * ratio(tests, rays);
    return Skipped{count, what, saved,
                   static_cast<double>(count) * ray_seconds + saved * test_seconds};
  };
  std::vector<Skipped> all{
      {counts.culled_tests, "tests of polygons in boxes that the ray does not enter", 0.0,
       static_cast<double>(counts.culled_tests) * test_seconds},
      {counts.records, "records of polygons that no ray of that origin came near", 0.0, 0.0},
      of_rays(counts.lights_behind, "shadow rays to lights that contribute nothing"),
      of_rays(counts.weightless, "reflected and refracted rays without weight"),
      of_rays(counts.dim, "reflected and refracted rays below --threshold"),
      of_rays(counts.empty_tile_rays, "camera rays where there is nothing"),
      {counts.first_occluders, "searches for a nearer occluder than the first", 0.0, 0.0}};
  if (render.intersect.hit.unit_tests != 0 &&
      (report.options.unit == "pipeline" || report.options.render.skips.divisions)) {
    const std::uint64_t quotients = 3 * render.intersect.hit.tests;
    all.push_back({quotients - std::min(quotients, render.intersect.hit.quotients),
                   "divisions of the paper's three per test", 0.0, 0.0});
  }
  std::erase_if(all, [](const Skipped& kind) { return kind.count == 0; });
  return all;
}

/// Returns the line about the samples that --error took and saved.
std::string samples_line(const Report& report) {
  const RenderSettings& light = report.options.render;
  const PixelRect& window = report.options.render.window;
  const double all = static_cast<double>(window.width()) * window.height() * light.samples;
  const double taken = all - static_cast<double>(report.render.spare_samples);
  return row("samples", format_fixed(100.0 * taken / all, 1) + " % of " +
                            format_count(static_cast<std::uint64_t>(light.samples)) +
                            " per pixel; skipped " + format_count(report.render.spare_samples) +
                            " that --error did not need");
}

std::string skipped_table(const Report& report) {
  std::string text =
      "Work skipped because it cannot change the picture (and the time it would have taken):\n";
  for (const Skipped& kind : skipped(report)) {
    std::string number = format_count(kind.count);
    number.insert(0, number.size() < 23 ? 23 - number.size() : 0, ' ');
    text += number + "  " + kind.what;
    std::string cost;
    if (kind.tests > 0.0) {
      cost = format_count(static_cast<std::uint64_t>(kind.tests)) + " tests";
    }
    if (kind.seconds > 0.0) cost += (cost.empty() ? "" : ", ") + format_duration(kind.seconds);
    text += (cost.empty() ? "" : " (" + cost + ")") + "\n";
  }
  return text;
}

std::string details(const Report& report) {
  const RenderStats& render = report.render;
  const HitCounters& hit = render.intersect.hit;
  std::string text = row("hits", format_count(hit.hits));
  text += row(
      "doubts",
      format_count(hit.edge_doubts) + " about edges, " + format_count(hit.depth_doubts) +
          " about the order of hits, settled by exact arithmetic" +
          (hit.exact_clocks > 0 ? ", in " + format_count(hit.exact_clocks, "clock") + " of the core"
                                : ""));
  text += row("points",
              format_count(render.point_doubts) + " computed by the host, as --point-error says");
  if (hit.clocks > 0) {
    text += row("unit", format_count(hit.unit_tests, "test") + ", " +
                            format_count(hit.quotients, "division"));
    if (report.options.unit == "pipeline") text += row("lanes", lane_clocks(report));
  }
  text += row("times", "load " + format_duration(report.load_seconds) + ", tree " +
                           format_duration(report.tree_seconds) + ", render " +
                           format_duration(render.wall_seconds) + ", write " +
                           format_duration(report.write_seconds));
  return text + row("threads", shares(render)) + skipped_table(report);
}

}  // namespace

double clocks_per_test(const HitCounters& counters) {
  return ratio(static_cast<double>(counters.clocks), static_cast<double>(counters.unit_tests));
}

std::string to_text(const Report& report) {
  const RenderStats& render = report.render;
  const HitCounters& hit = render.intersect.hit;
  const std::uint64_t others = render.rays - render.camera_rays - render.shadow_rays;
  std::string text = headline(report);
  text += row("rays", format_count(render.rays) + " (" + format_count(render.camera_rays) +
                          " camera, " + format_count(render.shadow_rays) + " shadow, " +
                          format_count(others) +
                          " others): " + rate(render.rays, render.wall_seconds, "rays"));
  text += row(
      "tests",
      format_count(hit.tests) + ", " +
          format_fixed(ratio(static_cast<double>(hit.tests), static_cast<double>(render.rays)), 1) +
          " per ray" +
          (hit.clocks > 0 ? ", " + format_count(hit.clocks) + " clocks, " +
                                format_fixed(clocks_per_test(hit), 2) + " per test"
                          : "") +
          ": " + rate(hit.tests, render.wall_seconds, "tests"));
  if (report.options.render.error > 0.0) text += samples_line(report);
  if (report.options.engine == Engine::kCheck) {
    text += row("check", "rtl and cpu agreed on all " + format_count(render.rays) + " rays");
  }
  if (report.rounding.corners > 0) {
    text += row("rounded", format_count(report.rounding.corners, "corner") +
                               " to binary32, by up to " + format_number(report.rounding.most));
  }
  std::string pictures;
  for (const auto& path : report.pictures) {
    pictures += (pictures.empty() ? "" : ", ") + printable(path.string());
  }
  text += row("wrote", pictures + " in " + format_duration(report.total_seconds));
  if (!report.view.empty()) text += row("view", report.view);
  for (const std::string& legend : report.legends) text += row("scale", legend);
  return report.options.verbose ? text + details(report) : text;
}

std::string to_json(const Report& report) {
  using nlohmann::ordered_json;
  const Options& options = report.options;
  const RenderStats& render = report.render;
  const HitCounters& hit = render.intersect.hit;
  const PixelRect& window = options.render.window;
  ordered_json pictures = ordered_json::array();
  for (const auto& path : report.pictures) pictures.push_back(path.string());
  ordered_json json = {{"software", kSoftware},
                       {"scene", options.scene_file.obj.string()},
                       {"triangles", report.triangles},
                       {"rounded_corners", report.rounding.corners},
                       {"largest_rounding", report.rounding.most},
                       {"width", options.render.width},
                       {"height", options.render.height},
                       {"window", {window.x0, window.y0, window.x1, window.y1}},
                       {"pictures", pictures},
                       {"variant", options.variant ? options.variant->name : "binary32"}};
  for (const auto& [name, value] : option_values(options, kInStats)) {
    json[name] = ordered_json::accept(value) ? ordered_json::parse(value) : ordered_json(value);
  }
  json.update(ordered_json{
      {"rays", render.rays},
      {"camera_rays", render.camera_rays},
      {"shadow_rays", render.shadow_rays},
      {"records", render.intersect.own_records + render.intersect.common_records},
      {"common_records", render.intersect.common_records},
      {"tests", hit.tests},
      {"misses", hit.misses},
      {"hits", hit.hits},
      {"edge_doubts", hit.edge_doubts},
      {"depth_doubts", hit.depth_doubts},
      {"exact_inside", render.intersect.exact_inside},
      {"exact_depth", render.intersect.exact_depth},
      {"host_decisions", render.intersect.exact_inside + render.intersect.exact_depth},
      {"point_doubts", render.point_doubts},
      {"plane_tests", hit.plane_tests},
      {"unit_tests", hit.unit_tests},
      {"quotients", hit.quotients},
      {"input_bytes", hit.input_bytes},
      {"clocks", hit.clocks},
      {"idle_clocks", hit.idle_clocks},
      {"output_stalls", hit.output_stalls},
      {"exact_clocks", hit.exact_clocks},
      {"clocks_per_test", clocks_per_test(hit)},
      {"skipped",
       {{"culled_tests", render.skipped.culled_tests},
        {"records", render.skipped.records},
        {"lights_behind", render.skipped.lights_behind},
        {"weightless", render.skipped.weightless},
        {"dim", render.skipped.dim},
        {"empty_tile_rays", render.skipped.empty_tile_rays},
        {"first_occluders", render.skipped.first_occluders},
        {"spare_samples", render.spare_samples}}},
      {"seconds",
       {{"load", report.load_seconds},
        {"tree", report.tree_seconds},
        {"render", render.wall_seconds},
        {"processor", render.processor_seconds},
        {"write", report.write_seconds},
        {"total", report.total_seconds}}},
      {"thread_seconds",
       {{"boxes", render.intersect.traverse},
        {"records", render.intersect.record},
        {"hit_tests", render.intersect.hit_tests},
        {"shading", render.shade_seconds}}},
  });
  // File names need not be UTF-8, JSON must be.
  return json.dump(2, ' ', true, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace raygate
