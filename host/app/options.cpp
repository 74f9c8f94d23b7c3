#include "host/app/options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/film/atomic_file.h"
#include "host/film/merge.h"
#include "host/render/adaptive_sampling.h"
#include "host/scene/io/text.h"
#include "sim/simulation.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

constexpr double kLargest = std::numeric_limits<float>::max(),
                 kFinite = std::numeric_limits<double>::max();
constexpr const char* kStandardOutput = "/dev/stdout";

constexpr const char* kAbout =
    R"(Usage: ./render SCENE [options]     SCENE.obj, .glb, .gltf, .ply or .stl, or a
                                    SCENE.json with its camera and lights
Renders a scene. A ray-tracing unit, simulated from its SystemVerilog, finds the
hits if the build has it; --engine cpu finds the same ones in C++, faster.
Writes SCENE.exr and SCENE.png into the current folder.

  ./render scenes/cornell.obj --engine cpu
  ./render scenes/teapot.obj -o pot.png --size 1280x720 --spp 16 --engine cpu
  ./render scenes/paper.obj --size 320x200 --lanes 4 --stats run.json
)";

constexpr const char* kFooter =
    R"(Exit status: 0 done; 1 the engines differ, or an internal error; 2 the command
line, the scene or an output cannot be used; 130 interrupted (partial pictures).)";

// Values of options. Their initialisation throws only if memory is lacking at the start.
// NOLINTBEGIN(bugprone-throwing-static-initialization)

const Choices<Engine> kEngines{{"rtl", Engine::kRtl},
                               {"model", Engine::kModel},
                               {"cpu", Engine::kCpu},
                               {"check", Engine::kCheck}};
const Choices<Arith> kAriths{{"structural", Arith::kStructural},
                             {"behavioural", Arith::kBehavioural}};
const Choices<bool ExtraChannels::*> kExtraChannels{
    {"P", &ExtraChannels::position},      {"Albedo", &ExtraChannels::albedo},
    {"objectId", &ExtraChannels::object}, {"tests", &ExtraChannels::tests},
    {"doubts", &ExtraChannels::doubts},   {"sums", &ExtraChannels::sums}};
const Choices<glm::dvec3> kAxes{{"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}},
                                {"-x", {-1, 0, 0}}, {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};
using Angles = std::pair<double, double>;
const Choices<Angles> kViews{{"front", {0, 0}},   {"back", {180, 0}},
                             {"left", {-90, 0}},  {"right", {90, 0}},
                             {"top", {0, 90}},    {"iso", {45, 35.264389682754654}},
                             {"bottom", {0, -90}}};  // "iso": all axes appear equally long
// NOLINTEND(bugprone-throwing-static-initialization)

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

bool read_size(const std::string& text, RenderSettings& settings) {
  const std::vector<int> sides = parse_list<int>(text, 'x');
  if (sides.size() != 2) return false;
  settings.width = sides[0];
  settings.height = sides[1];
  return kSideRange.contains(settings.width) && kSideRange.contains(settings.height);
}

/// Returns the variant of `text`: a name in variants.json, or a format such as "e8p15".
std::optional<Variant> parse_variant(const std::string& text) {
  for (const Variant& variant : all_variants_of_arithmetic()) {
    if (variant.name == text) return variant;
  }
  try {
    return variant_of_format(text);
  } catch (const InputError& error) {
    throw InputError("--variant: " + text + ": " + error.what());
  }
}

std::optional<CameraSetting> parse_camera(const std::string& text) {
  const std::vector<double> n = parse_list<double>(text);
  if (n.size() != 6 && n.size() != 7) return std::nullopt;
  const bool are_finite = std::ranges::all_of(n, [](double x) { return std::isfinite(x); });
  CameraSetting camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, std::nullopt, std::nullopt};
  if (n.size() == 7) camera.fov = n[6];
  if (!are_finite || camera.eye == camera.target || !kFovRange.contains(camera.fov.value_or(1.0))) {
    return std::nullopt;
  }
  return camera;
}

std::string vector_text(const glm::dvec3& v) { return list_text({v.x, v.y, v.z}); }

/// Returns the names of all channels that a film can have.
std::vector<std::string> channel_names() {
  Film film = make_film(1, 1, {0, 0, 1, 1}, {true, true, true, true, true});
  add_sums(film, true);
  std::vector<std::string> names;
  for (const Channel& channel : channels_of(film)) names.push_back(channel.name);
  return names;
}

// Rows of tables.

void add_core_options(OptionTable& table, Options& options) {
  CoreFileOptions& files = options.core_files;
  table.text("--dump-image", "FILE", "dump the ray cores' memory image; render nothing",
             files.image);
  table.add("--trace", "X,Y=FILE.vcd", "write a pixel's waveform; render nothing", "X,Y=FILE.vcd",
            [&files](const std::string& text) {
              const auto [pixel, file] = split_at_equals(text);
              const std::vector<int> xy = parse_list<int>(pixel);
              if (xy.size() != 2 || file.empty()) return false;
              files.pixel = {xy[0], xy[1]};
              files.wave = file;
              return true;
            });
  table.value<float>(
      "--point-error", "X",
      "compute points on the host where the unit's may be off by X of t (2^-16; 0: always; inf: "
      "never)",
      "a fraction of the distance, 0 or more, or inf", options.render.point_error,
      [](const std::string& text) -> std::optional<float> {
        const double error = text == "inf" ? kLargest : parse_number<double>(text).value_or(-1.0);
        if (!(error >= 0.0 && error <= kLargest)) return std::nullopt;
        return float_below(error);
      },
      [](float error) { return number_text(double{error}); }, kInExr | kInPage);
}

void add_camera_options(OptionTable& table, CameraRequest& request) {
  table.value<CameraSetting>(
      "--camera", "EX,EY,EZ,TX,TY,TZ[,FOV]",
      "eye, target, vertical field of view (the scene's, or a view of it all)",
      "EX,EY,EZ,TX,TY,TZ or EX,EY,EZ,TX,TY,TZ,FOV (an eye and another target, finite numbers; "
      "degrees above 0 and below 180)",
      request.camera, parse_camera,
      [](const CameraSetting& camera) {
        return vector_text(camera.eye) + "," + vector_text(camera.target) + "," +
               number_text(camera.fov.value_or(Camera::kDefaultFov));
      },
      kInExr | kInPage | kMostUsed);
  table.value<Angles>(
      "--view", "NAME|AZ,EL",
      "the whole scene and its area lights: " + listed(names_of(kViews), ", ") +
          ", or azimuth and elevation (33,24)",
      listed(names_of(kViews), ", ") +
          ", or AZIMUTH,ELEVATION in degrees (from -360 to 360, and from -90 to 90)",
      request.angles,
      [](const std::string& text) -> std::optional<Angles> {
        const std::vector<double> n = parse_list<double>(text);
        if (n.size() != 2) return value_of(kViews, text);
        if (!(std::abs(n[0]) <= 360.0 && std::abs(n[1]) <= 90.0)) return std::nullopt;
        return Angles(n[0], n[1]);
      },
      [](const Angles& angles) {
        return list_text({angles.first, angles.second});
      },
      kInExr | kInPage | kMostUsed);
  table.value<glm::dvec3>(
      "--up", "AXIS", "up axis: " + listed(names_of(kAxes)) + " (that of the format)",
      listed(names_of(kAxes)), request.up,
      [](const std::string& text) { return value_of(kAxes, in_lower_case(text)); }, vector_text,
      kInExr | kInPage);
  table.number("--fov", "DEGREES", "vertical field of view of any camera (35)", request.fov,
               kFovRange, kInExr | kInPage);
  table.choice<Projection>("--projection", "NAME", "perspective (default) or orthographic",
                           request.lens.projection,
                           {std::begin(kProjections), std::end(kProjections)}, kInExr | kInPage);
  table.number("--aperture", "R", "lens radius for depth of field; needs --spp (0)",
               request.lens.aperture, Range{0.0, kLargest, "the radius of a lens, 0 or more"},
               kInExr | kInPage);
  table.number(
      "--focus", "D", "focus distance (the target's)", request.lens.focus,
      Range<double>{std::numeric_limits<float>::min(), kLargest, "a distance, more than 0"},
      kInExr | kInPage);
  table.choice<bool>("--ground", "on|off", "shadow-catcher ground (on in default outdoor views)",
                     request.ground, {{"on", true}, {"off", false}}, kInExr);
}

void add_environment_options(OptionTable& table, EnvironmentSetting& environment) {
  table.add(
      "--environment", "FILE",
      "environment map, background and light: EXR or HDR, latitude-longitude", "a file",
      [&](const std::string& text) {
        environment = {.file = text};
        return true;
      },
      [&] { return environment.file.filename().string(); }, kInExr);
  table.number("--environment-rotation", "DEG", "counter-clockwise, seen from above (0)",
               environment.rotation, Range{-360.0, 360.0, "degrees from -360 to 360"}, kInExr);
  table.number("--environment-strength", "X", "radiance multiplier (1)", environment.strength,
               Range{0.0, 1e9, "a factor from 0 to 1e9"}, kInExr);
}

void add_run_options(OptionTable& table, Options& options) {
  table.text("--resume", "FILE.exr", "resume an unfinished render", options.resume);
  table.number("--save-every", "SECONDS", "save the unfinished picture now and then",
               options.output.save_seconds, Range{0.1, 1e6, "seconds from 0.1 to 1000000"});
  table.add("--stats", "FILE.json", "all statistics as JSON; - prints them", "a file or -",
            [&](const std::string& text) {
              options.output.stats = text == "-" ? kStandardOutput : text;
              return true;
            });
  table.flag("--serve", "show the scene in a page of the browser", options.serve);
  table.number("--port", "N", "of --serve's page (any free one)", options.port,
               Range<int>{1, 65535});
  table.flag("-q,--quiet", "print no statistics and no progress", options.quiet);
  table.flag("-v,--verbose", "print all statistics and warnings", options.verbose);
}

void add_render_options(OptionTable& table, Options& options) {
  RenderSettings& render = options.render;
  table.group("Engine");
  add_engine_options(table, options);
  add_core_options(table, options);
  table.group("Picture");
  add_picture_options(table, options.output);
  table.add(
      "--size", "WxH", "the frame in pixels ({})",
      "WIDTHxHEIGHT, each from 1 to " + std::to_string(kSideRange.high) + " pixels (640x480)",
      [&](const std::string& text) { return read_size(text, render); },
      [&] { return size_text(render.width, render.height); }, kInSceneFile | kInPage | kMostUsed);
  table.add("--crop", "X0,Y0,X1,Y1", "only this part of it; X1 and Y1 are not included", "",
            [&](const std::string& text) {
              const std::vector<int> n = parse_list<int>(text);
              render.window = n.size() == 4 ? PixelRect{n[0], n[1], n[2], n[3]}
                                            : PixelRect{0, 0, -1, -1};  // check_crop rejects this
              return true;
            });
  add_camera_options(table, options.camera);
  table.number("--smooth", "DEGREES", "smooth edges up to this angle (those of the OBJ's s)",
               options.smooth, kSmoothRange, kInExr);
  table.group("Light");
  add_light_options(table, render);
  add_environment_options(table, options.environment);
  table.group("Run");
  add_run_options(table, options);
}

// Checks of several options.

void check_crop(const OptionTable& table, RenderSettings& settings) {
  const std::string size = size_text(settings.width, settings.height);
  const bool is_whole = table.given("crop").empty();
  PixelRect& w = settings.window;
  if (is_whole) w = {0, 0, settings.width, settings.height};
  if (w.x0 < 0 || w.x0 >= w.x1 || w.x1 > settings.width || w.y0 < 0 || w.y0 >= w.y1 ||
      w.y1 > settings.height) {
    table.fail_value("crop", "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 within the frame of " + size +
                                 " (0,0 is the top left corner, X1 and Y1 are not included)");
  }
  if (std::int64_t{w.width()} * w.height() > kMaxPixels) {
    table.fail_value(is_whole ? "size" : "crop",
                     "at most " + std::to_string(kMaxPixels) +
                         " pixels in one run, for their memory (a larger frame can be rendered in "
                         "parts with --crop)");
  }
  const auto is_edge = [](int at, int end) { return at % kErrorBlock == 0 || at == end; };
  if (settings.error > 0.0 && (!is_edge(w.x0, 0) || !is_edge(w.y0, 0) ||
                               !is_edge(w.x1, settings.width) || !is_edge(w.y1, settings.height))) {
    table.fail_value("crop", "multiples of 4, or the frame's edge, with --error");
  }
}

void check_core_files(const OptionTable& table, const Options& options) {
  const CoreFileOptions& files = options.core_files;
  if (!files.image.empty() && !options.has_core()) {
    table.fail_value("dump-image", "with --unit core and no --engine cpu");
  }
  if (files.wave.empty()) return;
  if (!options.has_core() || !options.simulates()) {
    table.fail_value("trace", "with --unit core and --engine rtl or check");
  }
  const RenderSettings& render = options.render;
  const glm::ivec2& pixel = files.pixel;
  if (pixel.x < 0 || pixel.x >= render.width || pixel.y < 0 || pixel.y >= render.height) {
    table.fail_value("trace", "X,Y=FILE.vcd, a pixel of " + size_text(render.width, render.height));
  }
}

/// Throws InputError if --samples does not fit other options, or --false-colour lacks --error.
void check_samples(const OptionTable& table, Options& options) {
  const RenderSettings& render = options.render;
  if (render.end_sample > 0) {
    if (render.error > 0.0) {
      table.fail("--samples and --error exclude each other", {"samples", "error"});
    }
    if (render.end_sample > render.samples) {
      table.fail_value("samples", "some of the " + std::to_string(render.samples) + " of --spp");
    }
    if (!options.output.exr) throw InputError("--samples: expected an EXR among the outputs");
    options.output.channels.sums = true;
  }
  for (const FalseColorOutput& output : options.output.false_colors) {
    if (render.error == 0.0 && (output.channel == "samples" || output.channel == "error")) {
      throw InputError("--false-colour: expected --error for the channel " + output.channel);
    }
  }
}

void check_serve(const OptionTable& table, const Options& options) {
  if (!options.serve) {
    if (options.port != 0) throw InputError("--port: expected with --serve");
    return;
  }
  for (const char* name :
       {"crop", "error", "resume", "samples", "stats", "save-every", "trace", "dump-image"}) {
    if (table.given(name).empty()) continue;
    table.fail("--" + std::string(name) + " and --serve exclude each other", {name, "serve"});
  }
}

/// Throws InputError if an output would overwrite the scene or another output.
void require_distinct_outputs(const Options& options) {
  // Includes the .json beside the model, which the next run would read as its scene file.
  const fs::path inputs[] = {options.scene, options.scene_file.obj, options.scene_file.file,
                             fs::path(options.scene_file.obj).replace_extension(".json")};
  std::vector<fs::path> outputs = options.output.paths();
  for (const fs::path& path : options.core_files.paths()) outputs.push_back(path);
  require_distinct(outputs, inputs);
}

/// Reads the scene file that was named or is beside a model; else returns the model alone.
SceneFile scene_file_of(const fs::path& scene) {
  const fs::path beside = fs::path(scene).replace_extension(".json");
  std::error_code ignored;
  if (scene != beside && !fs::is_regular_file(beside, ignored))
    return {.file = scene, .obj = scene};
  if (scene != beside) require_model_ending(scene);  // so misspelt endings are errors
  SceneFile file = read_scene_file(beside);
  // The scene file's model may be elsewhere, if a script makes it.
  if (scene != beside && fs::exists(scene, ignored) &&
      file.obj.lexically_normal() != scene.lexically_normal()) {
    throw InputError(beside.string() + ": is about " + file.obj.string() + ", expected " +
                     scene.string() + " or another name");
  }
  return file;
}

}  // namespace

std::string to_string(Engine engine) { return name_of(kEngines, engine); }
std::string to_string(Arith arith) { return name_of(kAriths, arith); }

std::vector<fs::path> OutputOptions::pictures() const {
  std::vector<fs::path> all;
  if (exr) all.push_back(*exr);
  if (png) all.push_back(*png);
  for (const FalseColorOutput& output : false_colors) all.push_back(output.path);
  return all;
}

std::vector<fs::path> OutputOptions::paths() const {
  std::vector<fs::path> all = pictures();
  if (stats) all.push_back(*stats);
  return all;
}

ExtraChannels OutputOptions::needed_channels() const {
  ExtraChannels needed = channels;
  for (const FalseColorOutput& output : false_colors) {
    const std::string layer = output.channel.substr(0, output.channel.find('.'));
    if (const auto extra = value_of(kExtraChannels, layer)) needed.** extra = true;
  }
  return needed;
}

std::vector<fs::path> CoreFileOptions::paths() const {
  std::vector<fs::path> paths;
  for (const fs::path& path : {image, wave}) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

void add_engine_options(OptionTable& table, EngineOptions& options) {
  if (!has_simulation()) options.engine = Engine::kCpu;
  table.choice("--engine", "NAME",
               "rtl: simulated hardware; model: its model in C++; cpu: same hits, faster; check: "
               "rtl and cpu, compared ({})",
               options.engine, kEngines, kInStats | kInPage | kMostUsed);
  table.choice<std::string>(
      "--unit", "NAME", "pipeline, serial (the paper's), core, board ({})", options.unit,
      {{"pipeline", "pipeline"}, {"serial", "serial"}, {"core", "core"}, {"board", "board"}},
      kInStats | kInPage);
  std::vector<std::string> variants;
  for (const Variant& variant : all_variants_of_arithmetic()) variants.push_back(variant.name);
  table.value<Variant>(
      "--variant", "NAME", "number format of the model: e8p16; e8p16-raw: without error bounds",
      "exponent bits and digits as in e8p15 or e8p15-raw, " + listed(variants), options.variant,
      parse_variant, [](const Variant& variant) { return variant.name; }, kInExr | kInPage);
  table.choice("--arith", "NAME", "structural, or behavioural: + and * ({})", options.arith,
               kAriths, kInStats | kInPage);
  table.choice<int>("--lanes", "1|2|4|8", "pipelined units side by side, per thread ({})",
                    options.lanes, {{"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}}, kInStats | kInPage);
  table.number("--cores", "N", "ray cores behind one memory, per thread ({})", options.cores,
               Range{1, 64, "a whole number, 1 to 64"}, kInStats | kInPage);
  table.flag("--round-vertices", "round vertices to binary32, which ray cores need",
             options.rounds_vertices);
  table.text("--board-port", "PATH", "the serial port of a real board (--unit board)",
             options.board_port);
  table.number("--threads", "N", "threads (one per processor)", options.threads, kThreadRange,
               kInStats | kInPage);
  table.choice<InstanceMode>("--instances", "auto|keep|write",
                             "share repeated meshes, or expand them ({})", options.instances,
                             {{"auto", InstanceMode::kAutomatic},
                              {"keep", InstanceMode::kKeep},
                              {"write", InstanceMode::kFlatten}});
}

void add_picture_options(OptionTable& table, OutputOptions& options) {
  table.add(
      "-o,--output", "NAME", "NAME.exr, NAME.png, or NAME (or a folder) for both", "a name",
      [](const auto&) { return true; }, {}, kMostUsed);  // see name_outputs()
  table.number("--exposure", "STOPS", "PNG exposure in stops: +1 is twice as bright ({})",
               options.display.exposure,
               Range{-100.0, 100.0, "a number of stops from -100 to 100 (1 is twice as bright)"},
               kInSceneFile | kInPage | kMostUsed);
  table.choice<Tone>("--tone", "clip|filmic", "tone curve of the PNG ({})", options.display.tone,
                     {{"clip", Tone::kClip}, {"filmic", Tone::kFilmic}}, kInSceneFile | kInPage);
  std::vector<std::string> channels = names_of(kExtraChannels);
  channels.emplace_back("all");
  table.add("--channels", "NAMES",
            "extra EXR channels (AOVs; sums: for --resume and ./merge): " + listed(channels),
            "some of " + listed(channels, ", ") + " with commas between",
            [&options, channels](const std::string& text) {
              options.channels = {};
              for (const std::string& word : split_at(',', text)) {
                if (std::ranges::count(channels, word) == 0) return false;
                for (const auto& [name, member] : kExtraChannels) {
                  if (word == name || word == "all") options.channels.*member = true;
                }
              }
              return true;
            });
  table.add(
      "--false-colour,--false-color", "CHANNEL=FILE.png", "a channel in false colours",
      "CHANNEL=FILE.png; CHANNEL is " + listed(channel_names()),
      [&](const std::string& text) {
        const auto [channel, file] = split_at_equals(text);
        const std::vector<std::string> known = channel_names();
        options.false_colors.push_back({channel, file});
        return options.false_colors.back().path.extension() == ".png" &&
               std::ranges::count(known, channel) > 0;
      },
      {}, kInPage);
}

void add_light_options(OptionTable& table, RenderSettings& settings) {
  constexpr unsigned kEverywhere = kInExr | kInStats | kInPython | kInSceneFile | kInPage;
  table.choice<IntegratorKind>("--integrator", "NAME",
                               "primary: camera rays alone; whitted: shadows, reflection, "
                               "refraction; path: all global illumination ({}; path with an "
                               "environment)",
                               settings.integrator,
                               {{"primary", IntegratorKind::kPrimary},
                                {"whitted", IntegratorKind::kWhitted},
                                {"path", IntegratorKind::kPath}},
                               kEverywhere | kMostUsed);
  table.number("--spp", "N", "samples per pixel ({}; path by an environment: 16)", settings.samples,
               Range{1, 1 << 20}, kEverywhere | kMostUsed);
  table.number("--error", "X",
               "adaptive sampling: stop a pixel at n samples if its error is at most X n / 16 "
               "steps of an 8-bit display: X at 16 samples, 4 X at 64",
               settings.error,
               Range{std::numeric_limits<double>::min(), 255.0,
                     "steps of an 8-bit display, above 0 and up to 255"},
               kInExr | kInStats | kInPython | kInSceneFile);
  table.add("--samples", "A:B", "render only samples A to B-1, for ./merge",
            "A:B, from sample A to before sample B of --spp", [&](const std::string& text) {
              const SampleRange range = parse_sample_range(text);
              settings.first_sample = range.first;
              settings.end_sample = range.end;
              return range.end > 0;
            });
  table.choice<ReconstructionFilter>("--filter", "NAME", "pixel filter: box or {}", settings.filter,
                                     {{"box", ReconstructionFilter::kBox},
                                      {"blackman-harris", ReconstructionFilter::kBlackmanHarris}},
                                     kInExr | kInPython | kInSceneFile | kInPage);
  static constexpr Range<int> kDepths{0, 1000};
  table.add(
      "--depth,--max-depth", "N", "reflections and refractions in a row (4; path: 64)",
      kDepths.text(),
      [&](const std::string& text) {
        settings.max_depth = parse_number<int>(text);
        return settings.max_depth && kDepths.contains(*settings.max_depth);
      },
      [&] { return std::to_string(settings.depth()); }, kEverywhere);
  table.choice<bool>("--caustics", "auto|off", "path: caustics by light paths, unless --error ({})",
                     settings.caustics, {{"auto", true}, {"off", false}}, kInExr | kInPython);
  table.number("--threshold", "X", "whitted: ignore rays that weigh less ({})", settings.threshold,
               Range{0.0, 1.0}, kInExr | kInPython | kInSceneFile | kInPage);
  table.number("--ambient", "X", "whitted: ambient radiance (background or lights)",
               settings.ambient, Range{0.0, kFinite, "a radiance, 0 or more"},
               kInExr | kInPython | kInSceneFile | kInPage);
  table.number("--seed", "N", "seed of the random numbers ({})", settings.seed,
               Range<std::uint64_t>{0, std::numeric_limits<std::uint64_t>::max()},
               kInStats | kInPython | kInSceneFile | kInPage);
}

void check_engine_options(const OptionTable& table, EngineOptions& options) {
  if (!table.given("cores").empty() && !(options.unit == "core" && options.simulates())) {
    table.fail_value("cores", "with --unit core and --engine rtl or check");
  }
  if (options.variant) {
    const std::string unit =
        options.variant->unit == Variant::Unit::kSerial ? "serial" : "pipeline";
    for (const auto& [name, expected] :
         {std::pair{"engine", std::string("model")}, {"unit", unit}}) {
      const std::string given = table.given(name);
      if (given.empty() || given == expected) continue;
      table.fail_value(name, expected + " with --variant " + options.variant->name);
    }
    options.engine = Engine::kModel;
    options.unit = unit;
  }
  const bool has_board = !options.board_port.empty();
  if (has_board && !(options.unit == "board" && options.engine == Engine::kRtl)) {
    table.fail_value("board-port", "with --unit board and --engine rtl");
  }
  if (options.unit != "pipeline" && options.lanes != 1) {
    table.fail_value("lanes", "1 with --unit " + options.unit);
  }
  if (table.given("threads").empty()) {
    options.threads =
        has_board ? 1 : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  }
  if (has_board && options.threads != 1) table.fail_value("threads", "1 with --board-port");
  if (!options.has_core()) return;
  if (options.instances == InstanceMode::kKeep) {
    table.fail_value("instances", "auto or write with --unit " + options.unit);
  }
  options.instances = InstanceMode::kFlatten;  // a core's memory holds one tree
}

/// --output "a.exr" or "a.png" names only this file, "a" names both. A folder, or "" for the
/// current folder, gets both, named after the scene.
void name_outputs(const OptionTable& table, const fs::path& scene, OutputOptions& options) {
  fs::path name = table.given("output");
  std::error_code ignored;  // a name that cannot be looked up is no folder
  if (name.empty()) {
    name = scene.stem();
  } else if (!name.has_filename() || fs::is_directory(name, ignored)) {
    name /= scene.stem();
  } else if (name.has_extension() && name.extension() != ".exr" && name.extension() != ".png") {
    table.fail_value("output", "a name that ends in .exr or .png, or one without ending for both");
  } else if (name.has_extension()) {
    (name.extension() == ".exr" ? options.exr : options.png) = name;
  }
  if (!options.exr && !options.png) {
    options.exr = name.string() + ".exr";
    options.png = name.string() + ".png";
  }
  if (!table.given("channels").empty() && !options.exr) {
    throw InputError("--channels: expected an EXR among the outputs");
  }
}

void check_light_options(const OptionTable& table, bool has_environment, RenderSettings& settings) {
  constexpr int kPathSamples = 16, kMostSamples = 1024;
  const bool has_samples = !table.given("spp").empty();
  // Whitted neither shadows nor samples the environment.
  if (has_environment && table.given("integrator").empty()) {
    settings.integrator = IntegratorKind::kPath;
    if (!has_samples) settings.samples = kPathSamples;
  }
  if (settings.error > 0.0) {
    if (!has_samples) settings.samples = kMostSamples;
    if (settings.samples <= kMinAdaptiveSamples) {
      table.fail_value("spp", "more than the " + std::to_string(kMinAdaptiveSamples) +
                                  " that adaptive sampling to an error begins with");
    }
  }
}

Options parse_options(const std::vector<std::string>& words) {
  Options options;
  OptionTable table(kAbout, kFooter);
  add_render_options(table, options);
  const CommandLine line = table.split(words);
  if (line.plain.size() != 1) {
    throw InputError("found " + std::to_string(line.plain.size()) +
                     " scenes, expected one; try ./render scenes/cornell.obj");
  }
  options.scene = line.plain.front();
  options.scene_file = scene_file_of(options.scene);
  std::vector<OptionValue> given = options.scene_file.options;
  for (const OptionValue& value : given) table.require(value, kInSceneFile);
  given.insert(given.end(), line.values.begin(), line.values.end());
  return with_values(options, std::move(given));
}

Options with_values(const Options& scene, std::vector<OptionValue> given,
                    const std::vector<OptionValue>& requested) {
  Options options;
  options.scene = scene.scene;
  options.scene_file = scene.scene_file;
  options.camera = options.scene_file.camera;
  options.environment = options.scene_file.environment;
  OptionTable table;
  add_render_options(table, options);
  for (const OptionValue& value : requested) table.require(value, kInPage);
  given.insert(given.end(), requested.begin(), requested.end());
  table.read(given);
  options.given = std::move(given);
  RenderSettings& render = options.render;
  const bool has_environment = !options.environment.file.empty();
  for (const char* name : {"environment-rotation", "environment-strength"}) {
    if (!table.given(name).empty() && !has_environment)
      table.fail_value(name, "--environment, too");
  }
  check_light_options(table, has_environment, render);
  name_outputs(table, options.scene, options.output);
  check_crop(table, render);
  if (!table.given("view").empty()) {
    if (!table.given("camera").empty()) {
      throw InputError("--view and --camera exclude each other");
    }
    options.camera.camera.reset();  // overrides the scene file's camera
  }
  std::optional<CameraSetting>& camera = options.camera.camera;
  const std::optional<CameraSetting>& of_file = options.scene_file.camera.camera;
  if (camera && !camera->fov && of_file) camera->fov = of_file->fov;
  if (camera && camera->fov && table.given("fov").empty()) options.camera.fov.reset();
  check_engine_options(table, options);
  check_core_files(table, options);
  check_samples(table, options);
  check_serve(table, options);
  require_distinct_outputs(options);
  render.threads = options.threads;
  render.exposure = options.output.display.exposure;
  render.channels = options.output.needed_channels();
  return options;
}

std::vector<std::pair<std::string, std::string>> option_values(Options options,
                                                               OptionPlaces place) {
  OptionTable table;
  add_render_options(table, options);
  auto all = table.values(place);
  if (place != kInExr) return all;
  // Options without effect are omitted.
  std::erase(all, std::pair<std::string, std::string>("error", "0"));
  std::erase(all, std::pair<std::string, std::string>("caustics", "auto"));
  if (options.environment.file.empty()) {
    std::erase_if(all, [](const auto& value) { return value.first.starts_with("environment"); });
  }
  if (options.render.error > 0.0 && options.render.exposure != 0.0) {
    all.emplace_back("exposure", number_text(options.render.exposure));
  }
  return all;
}

}  // namespace raygate
