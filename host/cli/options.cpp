#include "host/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "host/base/input_error.h"
#include "host/cli/camera_options.h"
#include "host/cli/command_line.h"
#include "host/cli/help.h"
#include "host/cli/option_text.h"
#include "host/cli/values.h"
#include "host/render/adaptive_sampling.h"

namespace raygate {
namespace {

/// Option values as they were typed; empty where the option was not given.
struct RawValues {
  std::string scene, size, camera, view, up, fov, ground, crop, seed, smooth, resume;
  RawEngineOptions engine;
  RawCoreFileOptions core_files;
  RawOutputOptions output;
  RawLightOptions light;
  RawCameraOptions camera_values;
  bool no_scene_file = false;
};

/// Every name must be in kRenderHelp.
void declare(CLI::App& app, RawValues& raw, Options& options) {
  const auto value = [&app](const char* names, std::string& text) {
    app.add_option(names, text)->take_last();
  };
  const auto flag = [&app](const char* names, bool& on) {
    app.add_flag(names, on)->disable_flag_override();
  };
  app.add_option("scene", raw.scene);
  value("--size", raw.size);
  value("--crop", raw.crop);
  value("--camera", raw.camera);
  value("--view", raw.view);
  value("--up", raw.up);
  value("--fov", raw.fov);
  value("--ground", raw.ground);
  declare_output_options(app, raw.output);
  declare_light_options(app, raw.light);
  declare_camera_options(app, raw.camera_values);
  declare_engine_options(app, raw.engine);
  declare_core_file_options(app, raw.core_files);
  value("--seed", raw.seed);
  value("--smooth", raw.smooth);
  value("--resume", raw.resume);
  flag("--strict", options.strict);
  flag("--no-scene-file", raw.no_scene_file);
  flag("-q,--quiet", options.quiet);
  flag("-v,--verbose", options.verbose);
}

/// Flags go to `options`.
RawValues read_line(const std::vector<std::string>& words, Options& options) {
  RawValues raw;
  CLI::App app("", "render");
  declare(app, raw, options);
  options.information =
      read_command_line(app, words, kRenderHelp, "a second scene; one run renders one scene");
  return raw;
}

/// What --error asks for beside it.
void check_error(const RawValues& raw, Options& options) {
  if (raw.light.samples.empty()) options.light.samples = kMostSamples;
  if (options.light.samples <= kMinAdaptiveSamples) {
    fail_value(
        "--spp", raw.light.samples,
        "more than the " + std::to_string(kMinAdaptiveSamples) + " that --error begins with");
  }
  if (options.light.range) throw InputError("--samples: expected no --error beside it");
  const PixelRect& window = options.window;
  const auto is_edge = [](int at, int end) { return at % kErrorBlock == 0 || at == end; };
  if (!is_edge(window.x0, 0) || !is_edge(window.y0, 0) || !is_edge(window.x1, options.width) ||
      !is_edge(window.y1, options.height)) {
    fail_value("--crop", raw.crop, "multiples of 4, or the frame's edge, beside --error");
  }
}

void check_values(const RawValues& raw, Options& options) {
  options.output = parse_output_options(raw.output, options.scene);
  options.light = parse_light_options(raw.light);
  Size size{options.width, options.height};
  if (!raw.size.empty()) size = parse_size(raw.size);
  options.width = size.width;
  options.height = size.height;
  options.window = parse_crop(raw.crop, size);
  if (!raw.camera.empty() && !raw.view.empty()) {
    throw InputError("--view: expected no --camera beside it");
  }
  if (!raw.camera.empty() || !raw.view.empty()) {
    options.camera.reset();
    options.path.clear();
  }
  if (!raw.camera.empty()) options.camera = parse_camera(raw.camera);
  if (!raw.view.empty()) options.view.angles = parse_view(raw.view);
  if (!raw.up.empty()) options.view.up = parse_axis(raw.up);
  if (!raw.fov.empty()) options.view.fov = parse_fov(raw.fov);
  options.view.lens = parse_lens(raw.camera_values, options.view.lens);
  options.environment = parse_environment(raw.camera_values, options.environment);
  if (!raw.ground.empty()) {
    options.ground = choose<bool>("--ground", raw.ground, {{"on", true}, {"off", false}});
  }
  static_cast<EngineOptions&>(options) =
      parse_engine_options(raw.engine, {.processors = options.processors});
  options.core_files =
      parse_core_file_options(raw.core_files, options, {options.width, options.height});
  if (raw.light.samples.empty() && options.engine == Engine::kCpu) {
    options.light.samples = kCpuSamples;
  }
  if (options.light.error > 0.0) check_error(raw, options);
  if (const auto& range = options.light.range) {
    if (range->end > options.light.samples) {
      fail_value("--samples", raw.light.range,
                 "some of the " + std::to_string(options.light.samples) + " of --spp");
    }
    if (!options.output.exr) throw InputError("--samples: expected an EXR among the outputs");
    options.output.channels.sums = true;
  }
  for (const FalseColorOutput& output : options.output.false_colors) {
    if (options.light.error == 0.0 && (output.channel == "samples" || output.channel == "error")) {
      throw InputError("--false-colour: expected --error beside the channel " + output.channel);
    }
  }
  if (!raw.resume.empty()) {
    options.resume = raw.resume;
    const auto& film = options.output.exr;
    if (options.output.frames > 0 && (!film || *film != options.resume)) {
      fail_value("--resume", raw.resume,
                 film ? film->string() + " beside --frames, the animation's own name"
                      : "an EXR among the outputs of --frames");
    }
  }
  if (!raw.seed.empty()) options.seed = parse_seed(raw.seed);
  if (!raw.smooth.empty()) options.smooth = parse_smooth(raw.smooth);
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
  // A scene that is made, somewhere else, goes by the name of its scene file.
  if (!std::filesystem::exists(scene, ignored)) return file;
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

Options parse_options(int argc, const char* const* argv, unsigned processors) {
  std::vector<std::string> words(argv + 1, argv + argc);
  Options options;
  options.processors = processors;
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
    options.view.lens = options.scene_file->lens;
    options.environment = options.scene_file->lights.environment;
    if (!options.camera) {
      options.view.up = options.scene_file->up;
      options.view.fov = options.scene_file->fov;
    }
  }
  check_values(raw, options);
  require_distinct(options);
  return options;
}

}  // namespace raygate
