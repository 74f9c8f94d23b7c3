#include "host/app/outputs.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "host/app/built_in.h"
#include "host/app/console.h"
#include "host/film/display.h"

namespace raygate {
StagedFiles stage_files(const OutputOptions& options, const Film& film, const ExrMetadata& metadata,
                        int threads) {
  StagedFiles ready;
  const auto add_png = [&](const std::filesystem::path& path, Image8 picture) {
    if (metadata.attributes.contains(kPartialAttribute)) {
      picture.texts.emplace_back("Comment", kPartial);
    }
    ready.files.emplace_back(path, encode_png(picture));
  };
  if (options.exr) ready.files.emplace_back(*options.exr, encode_exr(film, metadata, threads));
  if (options.png) add_png(*options.png, to_display(film, options.display));
  for (const FalseColorOutput& output : options.false_colors) {
    const Image8 picture = false_color(film, output.channel);
    add_png(output.path, picture);
    ready.legends.push_back(picture.texts.at(0).second);
  }
  return ready;
}

std::string listed(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const auto& path : paths) names.push_back(printable(path.string()));
  return listed(names, ", ");
}

namespace {

double ratio(std::uint64_t a, double b) { return b > 0.0 ? static_cast<double>(a) / b : 0.0; }
double ratio(std::uint64_t a, std::uint64_t b) { return ratio(a, static_cast<double>(b)); }

struct Statistic {
  const char* key;  ///< "seconds.load": "load" within "seconds"
  nlohmann::ordered_json value;
  const char* meaning = nullptr;  ///< null: not printed by --verbose
};

/// Returns all statistics except options at kInStats, which to_json() inserts after "variant".
std::vector<Statistic> statistics(const Report& report, const Options& options) {
  const RenderStats& render = report.render;
  const IntersectCounters& work = render.intersect;
  const HitCounters& hit = work.hit;
  const PixelRect& window = options.render.window;
  std::vector<std::string> pictures;
  for (const auto& path : options.output.pictures()) pictures.push_back(path.string());
  return {
      {"software", kSoftware},
      {"scene", options.scene_file.obj.string()},
      {"triangles", report.triangles, "in the file"},
      {"rounded_corners", report.rounding.corners, "corners that binary32 cannot represent"},
      {"largest_rounding", report.rounding.most, "largest error of a coordinate"},
      {"width", options.render.width},
      {"height", options.render.height},
      {"window", {window.x0, window.y0, window.x1, window.y1}},
      {"pictures", pictures},
      {"variant", options.variant ? options.variant->name : "binary32"},
      {"rays", render.rays, "rays of all kinds"},
      {"camera_rays", render.camera_rays, "from the camera (none in empty tiles; more at lights)"},
      {"shadow_rays", render.shadow_rays, "of these, between surfaces and lights"},
      {"records", work.records, "polygon records made"},
      {"tests", hit.tests, "tests of a ray against a polygon"},
      {"misses", hit.misses, "tests with a sure miss"},
      {"hits", hit.hits, "tests with a sure hit"},
      {"edge_doubts", hit.edge_doubts, "tests that binary32 leaves undecided"},
      {"depth_doubts", hit.depth_doubts, "sure hits that binary32 cannot put in order"},
      {"exact_inside", work.exact_inside, "exact decisions of tests"},
      {"exact_depth", work.exact_depth, "exact decisions of the order of two hits"},
      {"host_decisions", work.exact_inside + work.exact_depth, "their sum; 0 with --unit core"},
      {"point_doubts", render.point_doubts, "hit points computed by the host (--point-error)"},
      {"plane_tests", hit.plane_tests, "points P computed by the unit"},
      {"unit_tests", hit.unit_tests, "tests by the hit-test unit; 0 with --engine cpu"},
      {"clocks", hit.clocks, "simulated clocks"},
      {"idle_clocks", hit.idle_clocks, "clocks of pipelined lanes without input"},
      {"output_stalls", hit.output_stalls, "clocks of pipelined lanes stalled by the consumer"},
      {"exact_clocks", hit.exact_clocks, "clocks of the ray cores' exact units"},
      {"clocks_per_test", ratio(hit.clocks, hit.unit_tests), "clocks / unit_tests"},
      {"unfinished_pixels", render.unfinished_pixels, "pixels for which --error needs more --spp"},
      {"skipped.first_occluders", work.ended_early, "searches ended by the first occluder"},
      {"skipped.spare_samples", render.spare_samples, "samples that --error did not need"},
      {"seconds.load", report.load_seconds, "elapsed: reading the scene"},
      {"seconds.tree", report.tree_seconds, "elapsed: building the tree"},
      {"seconds.render", render.wall_seconds, "elapsed: tracing and shading"},
      {"seconds.processor", render.processor_seconds, "processor time of all threads meanwhile"},
      {"seconds.write", report.write_seconds, "elapsed: writing the pictures"},
      {"seconds.total", report.total_seconds, "elapsed: the whole run"},
      {"thread_seconds.tracing", work.seconds, "traversal, tests and exact decisions"},
      {"thread_seconds.shading", render.shade_seconds, "making, shading and spawning rays"}};
}

/// Returns a line of the summary: the name, padded, and the value.
std::string row(std::string name, const std::string& value) {
  name.resize(9, ' ');
  return name + value + "\n";
}

/// Returns "1,234 rays/s".
std::string rate(std::uint64_t count, double seconds, const char* of_what) {
  return format_count(static_cast<std::uint64_t>(ratio(count, seconds))) + " " + of_what + "/s";
}

std::string headline(const Report& report, const Options& options) {
  const RenderSettings& render = options.render;
  const auto size = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  std::string line = printable(options.scene_file.obj.filename().string()) + ": " +
                     format_count(report.triangles, "triangle") + ", " +
                     size(render.width, render.height);
  const std::string window = size(render.window.width(), render.window.height());
  if (window != size(render.width, render.height)) line += " cropped to " + window;
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

/// Returns all numbers, one per line: key, value, meaning.
std::string details(const Report& report, const Options& options) {
  std::string text;
  for (const auto& [key, value, meaning] : statistics(report, options)) {
    if (meaning == nullptr) continue;
    const bool is_time = std::string_view(key).find("seconds.") != std::string_view::npos;
    std::string line = key;
    const std::string number = value.is_number_integer() ? format_count(value.get<std::uint64_t>())
                               : is_time                 ? format_duration(value.get<double>())
                                                         : format_number(value.get<double>());
    line.resize(std::max(line.size() + 1, 40 - std::min<std::size_t>(number.size(), 39)), ' ');
    text += line + number + "  " + meaning + "\n";
  }
  return text;
}

}  // namespace

std::string to_text(const Report& report, const Options& options) {
  const RenderStats& render = report.render;
  const HitCounters& hit = render.intersect.hit;
  const std::uint64_t others = render.rays - render.camera_rays - render.shadow_rays;
  std::string text = headline(report, options);
  text += row("rays", format_count(render.rays) + " (" + format_count(render.camera_rays) +
                          " camera, " + format_count(render.shadow_rays) + " shadow, " +
                          format_count(others) +
                          " others): " + rate(render.rays, render.wall_seconds, "rays"));
  const std::string clocks =
      hit.clocks == 0 ? ""
                      : ", " + format_count(hit.clocks) + " clocks, " +
                            format_fixed(ratio(hit.clocks, hit.unit_tests), 2) + " per test";
  text +=
      row("tests", format_count(hit.tests) + ", " + format_fixed(ratio(hit.tests, render.rays), 1) +
                       " per ray" + clocks + ": " + rate(hit.tests, render.wall_seconds, "tests"));
  if (const RenderSettings& asked = options.render; asked.error > 0.0) {
    const std::uint64_t pixels = asked.window.pixels(), most = std::uint64_t(asked.samples);
    text += row(
        "samples",
        format_fixed(100.0 - 100.0 * ratio(render.spare_samples, pixels * most), 1) + " % of " +
            format_count(most) + " per pixel; --error needs a higher --spp for " +
            format_fixed(100.0 * ratio(render.unfinished_pixels, pixels), 1) + " % of the pixels");
  }
  if (options.engine == Engine::kCheck) {
    text += row("check", "rtl and cpu agreed on all " + format_count(render.rays) + " rays");
  }
  if (report.rounding.corners > 0) {
    text += row("rounded", format_count(report.rounding.corners, "corner") +
                               " to binary32, by up to " + format_number(report.rounding.most));
  }
  text += row("wrote",
              listed(options.output.pictures()) + " in " + format_duration(report.total_seconds));
  if (!report.view.empty()) text += row("view", report.view);
  for (const std::string& legend : report.legends) text += row("scale", legend);
  return options.verbose ? text + details(report, options) : text;
}

std::string to_json(const Report& report, const Options& options) {
  using nlohmann::ordered_json;
  ordered_json json;
  for (const auto& [key, value, meaning] : statistics(report, options)) {
    std::string path = std::string("/") + key;
    std::ranges::replace(path, '.', '/');
    json[ordered_json::json_pointer(path)] = value;
    if (path != "/variant") continue;
    for (const auto& [name, text] : option_values(options, kInStats)) {
      json[name] = ordered_json::accept(text) ? ordered_json::parse(text) : ordered_json(text);
    }
  }
  // File names need not be UTF-8, but JSON must be.
  return json.dump(2, ' ', true, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace raygate
