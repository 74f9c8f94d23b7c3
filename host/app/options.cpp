#include "host/app/options.h"

#include "host/base/input_error.h"
#include "host/film/atomic_file.h"
#include "host/render/adaptive_sampling.h"

namespace raygate {
namespace {

constexpr const char* kAbout =
    R"(Usage: ./render SCENE [options]     SCENE.obj, .glb, .gltf, .ply or .stl, or a
                                    SCENE.json with its camera and lights
Renders a scene. A ray-tracing unit, simulated from its SystemVerilog, finds the
hits; --engine cpu gives identical hits without simulation, faster.
Writes SCENE.exr and SCENE.png into the current folder.

  ./render scenes/cornell.obj --engine cpu
  ./render scenes/teapot.obj -o pot.png --size 1280x720 --spp 16 --engine cpu
  ./render scenes/paper.obj --size 320x200 --lanes 4 --stats run.json
)";

constexpr const char* kFooter =
    R"(Exit status: 0 done; 1 the engines differ, or an internal error; 2 the command
line, the scene or an output cannot be used; 130 interrupted (partial pictures).)";

constexpr Range<int> kPortRange{1, 65535};

void require_pixels(const std::string& option, const std::string& text, int width, int height) {
  if (std::int64_t{width} * height <= kMaxPixels) return;
  fail_value(option, text,
             "at most " + std::to_string(kMaxPixels) +
                 " pixels in one run, for their memory (a larger frame can be rendered in parts "
                 "with --crop)");
}

std::string size_text(const RenderSettings& options) {
  return std::to_string(options.width) + "x" + std::to_string(options.height);
}

void read_size(const std::string& option, const std::string& text, RenderSettings& options) {
  const std::size_t x = text.find('x');
  const auto width = parse_number<int>(text.substr(0, x));
  const auto height =
      parse_number<int>(x == std::string::npos ? "" : std::string_view(text).substr(x + 1));
  if (!kSideRange.contains(width.value_or(0)) || !kSideRange.contains(height.value_or(0))) {
    fail_value(
        option, text,
        "WIDTHxHEIGHT, each from 1 to " + std::to_string(kSideRange.high) + " pixels (640x480)");
  }
  options.width = *width;
  options.height = *height;
}

/// All options of ./render, in the order of --help.
struct CommandLine {
  OptionTable table{kAbout, kFooter};
  std::string scene;
  bool no_scene_file = false;

  explicit CommandLine(Options& options) {
    RenderSettings& render = options.render;
    table.positional(scene);
    table.group("Engine");
    add_engine_options(table, options);
    add_core_file_options(table, options.core_files);
    add_skip_options(table, render);
    table.group("Picture");
    add_picture_options(table, options.output);
    table.add(
        "--size", "WxH", "the frame in pixels ({})",
        [&render](const std::string& option, const std::string& text) {
          read_size(option, text, render);
        },
        [&render] { return size_text(render); }, kInSceneFile | kInPage);
    table.add("--crop", "X0,Y0,X1,Y1", "only this part of it; X1 and Y1 are not included",
              [&render](const std::string& /*option*/, const std::string& text) {
                const auto n = parse_list<int>(text);
                const bool are_four = n && n->size() == 4;
                render.window = are_four ? PixelRect{(*n)[0], (*n)[1], (*n)[2], (*n)[3]}
                                         : PixelRect{0, 0, -1, -1};  // which check_crop refuses
              });
    add_camera_options(table, options.camera);
    table.number("--smooth", "DEGREES", "smooth edges up to this angle (the OBJ's s, or 30)",
                 options.smooth, kSmoothRange, kInExr);
    table.group("Light");
    add_light_options(table, render);
    add_environment_options(table, options.environment);
    table.group("Run");
    table.text("--resume", "FILE.exr", "resume an unfinished render", options.resume);
    add_run_output_options(table, options.output);
    table.flag("--serve", "show the scene in a page of the browser", options.serve);
    table.number("--port", "N", "of --serve's page (any free one)", options.port, kPortRange);
    table.flag("--strict", "refuse faces without area (they are left out)", options.strict);
    table.flag("--no-scene-file", "ignore the .json beside an OBJ", no_scene_file);
    table.flag("-q,--quiet", "print no statistics and no progress", options.quiet);
    table.flag("-v,--verbose", "print all statistics", options.verbose);
  }

  [[nodiscard]] std::string parse(const std::vector<std::string>& words) {
    return table.parse(words, "a second scene; one run renders one scene");
  }
};

void check_crop(const OptionTable& table, RenderSettings& options) {
  const std::string typed = table.typed("crop");
  PixelRect& window = options.window;
  if (typed.empty()) {
    window = {0, 0, options.width, options.height};
    require_pixels("--size", size_text(options), options.width, options.height);
    return;
  }
  if (window.x0 < 0 || window.x0 >= window.x1 || window.x1 > options.width || window.y0 < 0 ||
      window.y0 >= window.y1 || window.y1 > options.height) {
    fail_value("--crop", typed,
               "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 within the frame of " + size_text(options) +
                   " (0,0 is the top left corner, X1 and Y1 are not included)");
  }
  require_pixels("--crop", typed, window.width(), window.height());
}

/// Checks options that --error excludes or changes.
void check_error(const OptionTable& table, RenderSettings& options) {
  if (options.error == 0.0) return;
  check_adaptive_samples("--", table.typed("spp"), options);
  if (options.end_sample > 0) throw InputError("--samples and --error exclude each other");
  const PixelRect& window = options.window;
  const auto is_edge = [](int at, int end) { return at % kErrorBlock == 0 || at == end; };
  if (!is_edge(window.x0, 0) || !is_edge(window.y0, 0) || !is_edge(window.x1, options.width) ||
      !is_edge(window.y1, options.height)) {
    fail_value("--crop", table.typed("crop"), "multiples of 4, or the frame's edge, with --error");
  }
}

/// Checks options that --caustics on excludes; --caustics auto does without caustics instead.
void check_caustics(const RenderSettings& options) {
  if (options.caustics != Caustics::kOn) return;
  if (options.integrator != IntegratorKind::kPath) {
    throw InputError("--caustics on: expected --integrator path");
  }
  if (options.samples == 1) throw InputError("--caustics on: expected --spp 2 or more");
  if (options.error > 0.0) throw InputError("--caustics on and --error exclude each other");
}

/// Checks options against each other and sets defaults that depend on others.
void check(const OptionTable& table, Options& options) {
  RenderSettings& render = options.render;
  render.choose_integrator(options.environment.has_value(), !table.typed("integrator").empty(),
                           !table.typed("spp").empty());
  name_outputs(table, options.scene, options.output);
  check_crop(table, render);
  if (!table.typed("camera").empty() && !table.typed("view").empty()) {
    throw InputError("--view and --camera exclude each other");
  }
  check_engine_options(table, options);
  check_core_file_options(options.core_files, options, {render.width, render.height});
  check_error(table, render);
  check_caustics(render);
  if (render.end_sample > 0) {
    if (render.end_sample > render.samples) {
      fail_value("--samples", table.typed("samples"),
                 "some of the " + std::to_string(render.samples) + " of --spp");
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

/// Reads the scene file that was named, or the one beside a model; returns the model alone if there
/// is none.
SceneFile find_scene_file(const CommandLine& line) {
  const std::filesystem::path scene = line.scene;
  if (scene.extension() == ".json") {
    if (line.no_scene_file) throw InputError("--no-scene-file: expected an OBJ, got " + line.scene);
    return read_scene_file(scene);
  }
  const std::filesystem::path beside = std::filesystem::path(scene).replace_extension(".json");
  std::error_code ignored;
  if (line.no_scene_file || !std::filesystem::is_regular_file(beside, ignored)) {
    return {.file = scene, .obj = scene};
  }
  SceneFile file = read_scene_file(beside);
  // The model may be elsewhere, made by a script.
  if (!std::filesystem::exists(scene, ignored)) return file;
  if (file.obj.lexically_normal() != scene.lexically_normal()) {
    throw InputError(beside.string() + ": is about " + file.obj.string() + ", not " + line.scene +
                     "; --no-scene-file leaves it alone");
  }
  return file;
}

/// Returns the scene file's options as words of a command line, after checking each value.
std::vector<std::string> words_of(const SceneFile& file) {
  std::vector<std::string> words;
  for (const OptionSetting& setting : file.options) {
    words.push_back("--" + setting.name + "=" + setting.value);
    try {
      Options ignored;
      CommandLine line(ignored);
      line.table.require(setting.name, kInSceneFile, "render");
      (void)line.parse({words.back()});
    } catch (const InputError& error) {
      throw InputError(file.file.string(), setting.line, error.what());
    }
  }
  return words;
}

/// Throws InputError for options that exclude --serve.
void check_serve(const OptionTable& table, const Options& options) {
  if (!options.serve) {
    if (!table.typed("port").empty()) throw InputError("--port: expected with --serve");
    return;
  }
  for (const char* name :
       {"crop", "error", "resume", "samples", "stats", "save-every", "trace", "dump-image"}) {
    if (!table.typed(name).empty()) {
      throw InputError("--" + std::string(name) + " and --serve exclude each other");
    }
  }
}

/// Parses the scene file's options and then the command line, which overrides them. If an error
/// would not occur without an option of the file, the message names its line.
Options read_options(const Options& begin, const std::vector<std::string>& typed) {
  const auto read = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    Options options = begin;
    CommandLine line(options);
    (void)line.parse(words);
    check(line.table, options);
    check_serve(line.table, options);
    return options;
  };
  const auto error_of = [&](const auto&... words) -> std::string {
    try {
      (void)read(words...);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const SceneFile& file = begin.scene_file;
  const std::vector<std::string> settings = words_of(file);
  try {
    return read(settings, typed);
  } catch (const InputError& error) {
    for (std::size_t i = settings.size(); i-- > 0;) {
      std::vector<std::string> others = settings;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      if (!error_of(others, typed).empty()) continue;
      const OptionSetting& setting = file.options[i];
      if (error_of(settings, std::vector<std::string>()) == error.what()) {
        throw InputError(file.file.string(), setting.line, error.what());
      }
      throw InputError(std::string(error.what()) + " (" + file.file.string() + ":" +
                       std::to_string(setting.line) + " sets " + setting.name + ")");
    }
    throw;
  }
}

/// Throws InputError if an output would overwrite the scene or another output.
void require_distinct_outputs(const Options& options) {
  // Paths that cannot be resolved are refused when they are read or written.
  const auto resolve = [](const std::filesystem::path& path) {
    std::error_code error;
    return target_of(path, error);
  };
  std::vector<std::filesystem::path> paths{options.scene, options.scene_file.obj,
                                           options.scene_file.file};
  // The next run would read a file of this name with the scene.
  paths.push_back(std::filesystem::path(options.scene_file.obj).replace_extension(".json"));
  std::vector<std::filesystem::path> outputs = options.output.paths();
  for (const auto& path : options.core_files.paths()) outputs.push_back(path);
  for (const std::filesystem::path& output : outputs) {
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

Options parse_options(const std::vector<std::string>& words) {
  Options options;
  Options first;                // to find the scene's name
  first.environment.emplace();  // the scene file may have one
  CommandLine line(first);
  options.information = line.parse(words);
  if (!options.information.empty()) return options;
  if (line.scene.empty()) throw InputError("no scene given; try ./render scenes/cornell.obj");
  options.scene = line.scene;
  options.scene_file = find_scene_file(line);
  std::error_code ignored;
  options.is_bare_model =
      options.scene_file.file == options.scene_file.obj &&
      !std::filesystem::exists(std::filesystem::path(line.scene).replace_extension(".json"),
                               ignored);
  return with_words(options, words);
}

Options with_words(const Options& given, const std::vector<std::string>& words) {
  Options options;
  options.scene = given.scene;
  options.scene_file = given.scene_file;
  options.is_bare_model = given.is_bare_model;
  options.camera = camera_request(options.scene_file);
  options.environment = options.scene_file.environment;
  options = read_options(options, words);
  options.words = words;
  require_distinct_outputs(options);
  options.render.threads = options.threads;
  options.render.exposure = options.output.display.exposure;
  options.render.channels = options.output.needed_channels();
  return options;
}

std::vector<std::pair<std::string, std::string>> option_values(Options options,
                                                               OptionPlaces place) {
  return CommandLine(options).table.values(place);
}

void require_page_option(const std::string& name) {
  Options ignored;
  CommandLine(ignored).table.require(name, kInPage, "request");
}

std::vector<std::pair<std::string, std::string>> picture_options(const Options& options,
                                                                 const Framing& framing) {
  auto all = option_values(options, kInExr);
  if (options.render.error == 0.0) {
    std::erase(all, std::pair<std::string, std::string>("error", "0"));
  } else if (options.render.exposure != 0.0) {
    all.emplace_back("exposure", number_text(options.render.exposure));
  }
  all.insert(all.end(), framing.options.begin(), framing.options.end());
  if (const auto& environment = options.environment) {
    all.emplace_back("environment", environment->file.filename().string());
    all.emplace_back("environmentRotation", number_text(environment->rotation));
    all.emplace_back("environmentStrength", number_text(environment->strength));
  }
  return all;
}

}  // namespace raygate
