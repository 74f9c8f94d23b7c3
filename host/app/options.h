// Options of the programs and of Python's pictures: values, table rows, checks that they fit.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/app/load.h"
#include "host/app/option_table.h"
#include "host/film/display.h"
#include "host/film/film.h"
#include "host/render/render_settings.h"
#include "host/scene/instances.h"
#include "host/scene/io/scene_loader.h"
#include "host/variants/variant_table.h"
#include "sim/arith.h"

namespace raygate {

/// The engine that tests rays against triangles.
enum class Engine {
  kRtl,    ///< the simulated hardware
  kModel,  ///< the hardware's reference model in C++
  kCpu,    ///< the host's own tests
  kCheck,  ///< rtl and cpu, compared ray by ray
};

struct EngineOptions {
  Engine engine = Engine::kRtl;
  std::string unit = "pipeline";     ///< "pipeline", "serial", "core" or "board"
  std::optional<Variant> variant{};  ///< number format of the model; none: binary32
  Arith arith = Arith::kStructural;
  int lanes = 1;             ///< lanes of the pipelined unit: 1, 2, 4 or 8; 1 for other units
  std::string board_port{};  ///< serial port of unit "board"; "": the board is simulated
  int cores = 1;             ///< ray cores behind one memory, per thread; 1 for other units
  int threads = 1;
  InstanceMode instances = InstanceMode::kAutomatic;
  bool rounds_vertices = false;  ///< rounds vertices to binary32

  /// Returns whether rays go to ray cores, simulated or modelled.
  [[nodiscard]] bool has_core() const {
    return (unit == "core" || unit == "board") && engine != Engine::kCpu;
  }
  [[nodiscard]] bool simulates() const {
    return engine == Engine::kRtl || engine == Engine::kCheck;
  }
};

/// A picture of one channel in false colours.
struct FalseColorOutput {
  std::string channel;  ///< name in the EXR: "Z", "N.X", "tests"
  std::filesystem::path path;
};

/// The output files of a run.
struct OutputOptions {
  std::optional<std::filesystem::path> exr;  ///< at least one of exr and png is set
  std::optional<std::filesystem::path> png;
  std::vector<FalseColorOutput> false_colors;
  std::optional<std::filesystem::path> stats;  ///< run statistics as JSON
  ExtraChannels channels;                      ///< extra channels of the EXR
  DisplayOptions display;                      ///< of the PNG
  double save_seconds = 0.0;                   ///< between saves of the unfinished picture; 0: none

  [[nodiscard]] std::vector<std::filesystem::path> pictures() const;
  /// Returns the files of the pictures and the statistics.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  /// Returns the channels that a film needs for these files.
  [[nodiscard]] ExtraChannels needed_channels() const;
};

/// Files about a ray core that are written instead of a picture.
struct CoreFileOptions {
  std::filesystem::path image;  ///< memory image; "": none
  std::filesystem::path wave;   ///< waveform of `pixel`'s ray; "": none
  glm::ivec2 pixel{0};

  /// Returns the files that will be written.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
};

/// The options of ./render. Every value is in its range; files are not checked.
struct Options : EngineOptions {
  std::filesystem::path scene;  ///< the file that was named: a model or a scene file
  SceneFile scene_file;         ///< the scene file that was named or is beside the model
  /// Values in the scene file, followed by those on the command line, which override them.
  std::vector<OptionValue> given;
  RenderSettings render;
  CameraRequest camera;
  EnvironmentSetting environment;
  OutputOptions output;
  CoreFileOptions core_files;
  std::filesystem::path resume;  ///< EXR to resume; "": none
  bool serve = false;            ///< serve a page instead of writing files
  int port = 0;                  ///< of the page; 0: any free port
  bool quiet = false, verbose = false;
  std::optional<double> smooth;  ///< LoadOptions::smooth, in degrees
};

/// Ranges of options that the Python module has, too.
inline constexpr Range<int> kThreadRange{1, 1024}, kSideRange{1, 65536};
inline constexpr Range<double> kFovRange{0x1p-1022, 180.0 - 0x1p-45,
                                         "degrees above 0 and below 180"},
    kSmoothRange{0.0, 180.0, "degrees from 0 to 180"};

/// Returns "rtl", "model", "cpu" or "check".
[[nodiscard]] std::string to_string(Engine engine);
/// Returns "structural" or "behavioural".
[[nodiscard]] std::string to_string(Arith arith);

/// Adds the engine options, which ./render and ./trace have.
void add_engine_options(OptionTable& table, EngineOptions& options);
/// Adds the options of picture files, which ./render and ./merge have.
void add_picture_options(OptionTable& table, OutputOptions& options);
/// Adds the options of integrators and sampling, which ./render and the Python module have.
void add_light_options(OptionTable& table, RenderSettings& settings);

/// Throws InputError for incompatible options, and sets defaults that depend on other options.
void check_engine_options(const OptionTable& table, EngineOptions& options);
/// Sets the names of the pictures, by default `scene`'s name in the current folder. Throws
/// InputError for unknown endings, and for --channels without an EXR.
void name_outputs(const OptionTable& table, const std::filesystem::path& scene,
                  OutputOptions& options);
/// Sets the default integrator and samples per pixel, which depend on the environment map and on
/// adaptive sampling. Throws InputError if the samples are too few for adaptive sampling.
void check_light_options(const OptionTable& table, bool has_environment, RenderSettings& settings);

/// Parses the options of the scene file, then a command line without the program's name, which
/// overrides them. Throws InputError, and Information for --help and --version.
[[nodiscard]] Options parse_options(const std::vector<std::string>& words);

/// Returns the options for the scene file of `scene`: the values `given`, overridden by
/// `requested`, options at kInPage from the page of --serve. Throws InputError.
[[nodiscard]] Options with_values(const Options& scene, std::vector<OptionValue> given,
                                  const std::vector<OptionValue>& requested = {});

/// Returns name/value pairs of the options shown at `place`.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> option_values(Options options,
                                                                             OptionPlaces place);

}  // namespace raygate
