#include "host/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <thread>

#include "host/cli/values.h"
#include "host/cli/version.h"
#include "host/scene/input_error.h"

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
    "  130  interrupted (Ctrl-C); 143 terminated. Output files are as they were before\n"
    "\n"
    "Equal scenes and options give equal bytes, whatever the engine and the number of threads.\n"
    "\n"
    "Examples:\n"
    "  ./render scenes/cornell.obj\n"
    "  ./render scenes/teapot.obj -o pot.png --size 1280x720 --engine cpu\n"
    "  ./render scenes/paper.obj --size 320x200 --engine check --stats run.json";

/// Option values as they were typed; empty where the option was not given.
struct RawValues {
  std::string scene, output, size, engine, unit, lanes, threads, camera, crop, seed, stats;
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
  app.add_option("scene", raw.scene, "a Wavefront OBJ file; its MTL files are read with it")
      ->type_name("SCENE.obj");
  value("-o,--output", raw.output, "NAME",
        "what to write: NAME.exr, NAME.png, or NAME\nfor both; a folder for both in there");
  value("--size", raw.size, "WxH", "the frame in pixels (640x480)");
  value("--crop", raw.crop, "X0,Y0,X1,Y1",
        "only these pixels of the frame; 0,0 is the top\nleft one, X1 and Y1 are not included");
  value("--camera", raw.camera, "EX,EY,EZ,TX,TY,TZ[,FOV]",
        "eye and target in the file's coordinates, and\n"
        "vertical field of view in degrees (35);\n"
        "without it, the whole scene is framed");
  value("--engine", raw.engine, "rtl|cpu|check",
        "rtl: the simulated hardware; cpu: its twin in\n"
        "C++; check: both, and the first difference\nstops the run (rtl)");
  value("--unit", raw.unit, "pipeline|serial",
        "which hit-test unit the hardware is: a test\n"
        "every clock, or the paper's (pipeline)");
  value("--lanes", raw.lanes, "1|2|4|8", "pipelined units side by side, per thread (1)");
  value("--threads", raw.threads, "N", "threads on the host (one for each processor)");
  value("--seed", raw.seed, "N", "start of all random numbers (0)");
  flag("--skip-degenerate", options.skip_degenerate,
       "leave out faces without area, with a warning,\ninstead of refusing the scene");
  value("--stats", raw.stats, "FILE.json", "write the statistics of the run as JSON");
  flag("-q,--quiet", options.quiet, "no progress bar and no statistics");
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version", std::string(kSoftware), "print the version");
}

/// CLI11's complaints in our words, one line each.
void parse(CLI::App& app, int argc, const char* const* argv, Options& options) {
  app.allow_extras();  // so that an unknown option can be answered with the known ones
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    options.information = app.help();
  } catch (const CLI::CallForVersion&) {
    options.information = std::string(kSoftware) + "\n";
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) + " (see --help)");
  }
  if (!options.information.empty()) return;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw InputError(option->get_name() + ": expected a value, got ''");
    }
  }
  const std::vector<std::string> extras = app.remaining();
  if (extras.empty()) return;
  if (extras[0].size() > 1 && extras[0][0] == '-') {
    throw InputError(extras[0] + ": unknown option; the options are " + names_of(app));
  }
  throw InputError(extras[0] + ": a second scene; one run renders one scene");
}

/// No output may take the place of the scene or of another output.
void require_distinct(const Options& options) {
  // What cannot be resolved is refused where it is read or written.
  const auto resolve = [](const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  };
  std::vector<std::filesystem::path> paths{options.scene};
  for (const auto& output : {options.exr, options.png, options.stats}) {
    if (!output) continue;
    const std::filesystem::path resolved = resolve(*output);
    for (const auto& other : paths) {
      if (!resolved.empty() && resolved == resolve(other)) {
        throw InputError(output->string() + ": would overwrite " + other.string());
      }
    }
    paths.push_back(*output);
  }
}

}  // namespace

std::string to_string(Engine engine) {
  switch (engine) {
    case Engine::kRtl:
      return "rtl";
    case Engine::kCpu:
      return "cpu";
    case Engine::kCheck:
      return "check";
  }
  return "";
}

Options parse_options(int argc, const char* const* argv) {
  Options options;
  RawValues raw;
  CLI::App app(kDescription, "render");
  app.footer(kFooter);
  app.get_formatter()->column_width(30);
  declare(app, raw, options);
  parse(app, argc, argv, options);
  if (!options.information.empty()) return options;

  if (raw.scene.empty()) throw InputError("no scene given; try ./render scenes/cornell.obj");
  options.scene = raw.scene;
  const Outputs outputs = parse_output(raw.output, options.scene);
  options.exr = outputs.exr;
  options.png = outputs.png;
  if (!raw.stats.empty()) options.stats = raw.stats;
  Size size{options.width, options.height};
  if (!raw.size.empty()) size = parse_size(raw.size);
  options.width = size.width;
  options.height = size.height;
  options.window = parse_crop(raw.crop, size);
  if (!raw.camera.empty()) options.camera = parse_camera(raw.camera);
  if (!raw.engine.empty()) options.engine = parse_engine(raw.engine);
  if (!raw.unit.empty()) options.unit = parse_unit(raw.unit);
  if (!raw.lanes.empty()) options.lanes = parse_lanes(raw.lanes);
  if (options.unit == "serial" && options.lanes != 1) {
    throw InputError("--lanes: expected 1 with --unit serial, got " + raw.lanes);
  }
  options.threads = raw.threads.empty() ? std::max(1u, std::thread::hardware_concurrency())
                                        : parse_threads(raw.threads);
  if (!raw.seed.empty()) options.seed = parse_seed(raw.seed);
  require_distinct(options);
  return options;
}

}  // namespace raygate
