#include "host/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "host/cli/values.h"
#include "host/cli/version.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

constexpr const char* kDescription =
    "Renders a Wavefront OBJ scene; the rays' hits are found by a hardware unit, simulated from\n"
    "its SystemVerilog. Writes SCENE.exr and SCENE.png into the current folder.";

constexpr const char* kFooter =
    "Exit status:\n"
    "  0    the pictures are written\n"
    "  1    the engines differ (--engine check), or an error of the program itself\n"
    "  2    the command line, the scene or an output file cannot be used\n"
    "  130  interrupted (Ctrl-C); 143 terminated. What was rendered by then is written\n"
    "\n"
    "Equal scenes and options give equal bytes, whatever the engine and the number of threads.\n"
    "\n"
    "Examples:\n"
    "  ./render scenes/cornell.obj\n"
    "  ./render scenes/teapot.obj --frames 24 -o /tmp/turn.png --engine cpu\n"
    "  ./render scenes/teapot.obj -o pot.png --size 1280x720 --engine cpu\n"
    "  ./render scenes/paper.obj --size 320x200 --engine check --stats run.json";

/// Option values as they were typed; empty where the option was not given.
struct RawValues {
  std::string scene, size, engine, unit, arith, lanes, threads, camera, crop, seed;
  RawOutputOptions output;
  RawLightOptions light;
  bool no_scene_file = false;
};

/// All names, for the message about an unknown one.
std::string names_of(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) continue;
    std::string name = option->get_name(false, true);  // "-o,--output"
    std::replace(name.begin(), name.end(), ',', '/');
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

void declare(CLI::App& app, RawValues& raw, Options& options) {
  const auto value = [&app](const char* names, std::string& text, const char* form,
                            const char* help) {
    app.add_option(names, text, help)->type_name(form)->take_last();
  };
  const auto flag = [&app](const char* names, bool& on, const char* help) {
    app.add_flag(names, on, help)->disable_flag_override();
  };
  app.add_option(
         "scene", raw.scene,
         "a Wavefront OBJ file, or a scene file (see\nscenes/README.md) with camera and lights")
      ->type_name("SCENE.obj|.json");
  value("--size", raw.size, "WxH", "the frame in pixels (640x480)");
  value("--crop", raw.crop, "X0,Y0,X1,Y1",
        "only these pixels of the frame; 0,0 is the top\nleft one, X1 and Y1 are not included");
  value("--camera", raw.camera, "EX,EY,EZ,TX,TY,TZ[,FOV]",
        "eye and target in the file's coordinates, and\n"
        "vertical field of view in degrees (35);\n"
        "without it, the whole scene is framed");
  declare_output_options(app, raw.output);
  declare_light_options(app, raw.light);
  value("--engine", raw.engine, "rtl|model|cpu|check",
        "rtl: the simulated hardware; model: its reference\n"
        "model in C++; cpu: fast tests without a unit; check:\n"
        "rtl and cpu, and the first difference stops the run\n(rtl)");
  value("--unit", raw.unit, "pipeline|serial",
        "which hit-test unit the hardware is: a test\n"
        "every clock, or the paper's (pipeline)");
  value("--arith", raw.arith, "structural|behavioural",
        "the hardware's arithmetic: Booth trees and carry-\n"
        "select adders, or + and *, simulated faster;\nthe same bits (structural)");
  value("--lanes", raw.lanes, "1|2|4|8", "pipelined units side by side, per thread (1)");
  value("--threads", raw.threads, "N", "threads on the host (one for each processor)");
  value("--seed", raw.seed, "N", "start of all random numbers (0)");
  flag("--skip-degenerate", options.skip_degenerate,
       "leave out faces without area, with a warning,\ninstead of refusing the scene");
  flag("--no-scene-file", raw.no_scene_file, "don't read the .json beside an OBJ");
  flag("-q,--quiet", options.quiet, "no progress bar and no statistics");
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", std::string(kSoftware), "print the version");
}

/// Reads a command line; CLI11's complaints in our words, one line each. Flags go to `options`.
RawValues read_line(const std::vector<std::string>& words, Options& options) {
  RawValues raw;
  CLI::App app(kDescription, "render");
  app.footer(kFooter);
  app.get_formatter()->column_width(30);
  declare(app, raw, options);
  app.allow_extras();  // so that an unknown option can be answered with the known ones
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());  // as the library wants them
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    options.information = app.help();
  } catch (const CLI::CallForVersion&) {
    options.information = std::string(kSoftware) + "\n";
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  if (!options.information.empty()) return raw;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw InputError(option->get_name() + ": expected a value, got ''");
    }
  }
  const std::vector<std::string> extras = app.remaining();
  if (extras.empty()) return raw;
  if (extras[0].size() > 1 && extras[0][0] == '-') {
    throw InputError(extras[0] + ": unknown option; the options are " + names_of(app));
  }
  throw InputError(extras[0] + ": a second scene; one run renders one scene");
}

void check_values(const RawValues& raw, Options& options) {
  options.output = parse_output_options(raw.output, options.scene);
  options.light = parse_light_options(raw.light);
  Size size{options.width, options.height};
  if (!raw.size.empty()) size = parse_size(raw.size);
  options.width = size.width;
  options.height = size.height;
  options.window = parse_crop(raw.crop, size);
  if (!raw.camera.empty()) {
    options.camera = parse_camera(raw.camera);
    options.path.clear();
  }
  if (!raw.engine.empty()) options.engine = parse_engine(raw.engine);
  if (!raw.unit.empty()) options.unit = parse_unit(raw.unit);
  if (!raw.arith.empty()) options.arith = parse_arith(raw.arith);
  if (!raw.lanes.empty()) options.lanes = parse_lanes(raw.lanes);
  if (options.unit == "serial" && options.lanes != 1) {
    throw InputError("--lanes: expected 1 with --unit serial, got " + raw.lanes);
  }
  options.threads = raw.threads.empty() ? std::max(1u, std::thread::hardware_concurrency())
                                        : parse_threads(raw.threads);
  if (!raw.seed.empty()) options.seed = parse_seed(raw.seed);
}

/// The file that the scene is, or that stands beside it.
std::optional<SceneFile> find_scene_file(const RawValues& raw) {
  const std::filesystem::path scene = raw.scene;
  if (scene.extension() == ".json") {
    if (raw.no_scene_file) throw InputError("--no-scene-file: expected an OBJ, got " + raw.scene);
    return read_scene_file(scene);
  }
  const std::filesystem::path beside = std::filesystem::path(scene).replace_extension(".json");
  std::error_code ignored;
  if (raw.no_scene_file || !std::filesystem::is_regular_file(beside, ignored)) return std::nullopt;
  SceneFile file = read_scene_file(beside);
  if (file.obj.lexically_normal() != scene.lexically_normal()) {
    throw InputError(beside.string() + ": is about " + file.obj.string() + ", not " + raw.scene +
                     "; --no-scene-file leaves it alone");
  }
  return file;
}

/// The scene file's options as words of a command line, each of them checked.
std::vector<std::string> words_of(const SceneFile& file) {
  std::vector<std::string> words;
  for (const OptionSetting& setting : file.options) {
    words.push_back("--" + setting.name + "=" + setting.value);
    try {
      Options ignored;
      check_values(read_line({words.back()}, ignored), ignored);
    } catch (const InputError& error) {
      throw InputError(file.file.string(), setting.line, error.what());
    }
  }
  return words;
}

/// No output may take the place of the scene or of another output.
void require_distinct(const Options& options) {
  // What cannot be resolved is refused where it is read or written.
  const auto resolve = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  std::vector<std::filesystem::path> paths{options.scene, options.obj()};
  // A file of this name would be read with the scene next time.
  paths.push_back(std::filesystem::path(options.obj()).replace_extension(".json"));
  if (options.scene_file) paths.push_back(options.scene_file->file);
  for (const std::filesystem::path& output : options.output.paths()) {
    const std::filesystem::path resolved = resolve(output);
    for (const auto& other : paths) {
      if (!resolved.empty() && resolved == resolve(other)) {
        throw InputError(output.string() + ": would overwrite " + other.string());
      }
    }
    paths.push_back(output);
  }
}

}  // namespace

std::string to_string(Engine engine) {
  switch (engine) {
    case Engine::kRtl:
      return "rtl";
    case Engine::kModel:
      return "model";
    case Engine::kCpu:
      return "cpu";
    case Engine::kCheck:
      return "check";
  }
  return "";
}

std::string to_string(Arith arith) {
  return arith == Arith::kStructural ? "structural" : "behavioural";
}

Options parse_options(int argc, const char* const* argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  Options options;
  RawValues raw = read_line(words, options);
  if (!options.information.empty()) return options;
  if (raw.scene.empty()) throw InputError("no scene given; try ./render scenes/cornell.obj");
  options.scene = raw.scene;
  options.scene_file = find_scene_file(raw);
  if (options.scene_file) {
    // Of two values of an option the later one counts.
    const std::vector<std::string> settings = words_of(*options.scene_file);
    words.insert(words.begin(), settings.begin(), settings.end());
    raw = read_line(words, options);
    options.camera = options.scene_file->camera;
    options.path = options.scene_file->path;
  }
  check_values(raw, options);
  require_distinct(options);
  return options;
}

}  // namespace raygate
