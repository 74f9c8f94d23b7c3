// The options of ./render.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/app/output_options.h"
#include "host/app/render_options.h"
#include "host/scene/io/scene_file.h"

namespace raygate {

/// Checked options: every value is in its range. Files are not checked.
struct Options : EngineOptions {
  /// Output of --help or --version; if not empty, the other members are not valid.
  std::string information;

  std::vector<std::string> words;  ///< as typed, without the program's name
  std::filesystem::path scene;     ///< the file that was named: a model or a scene file
  SceneFile scene_file;            ///< that scene file or the one beside the model; else the model
  RenderSettings render;
  CameraRequest camera;
  std::optional<EnvironmentSetting> environment;
  OutputOptions output;
  CoreFileOptions core_files;
  std::filesystem::path resume;  ///< EXR to resume; "": none
  bool serve = false;            ///< serve a page instead of writing files
  int port = 0;                  ///< of the page; 0: any free port
  bool quiet = false, verbose = false;
  bool strict = false;           ///< refuse faces without area
  std::optional<double> smooth;  ///< LoadOptions::smooth, in degrees
  bool is_bare_model = false;    ///< whether there is no scene file, not even an ignored one
};

/// Parses a command line, without the program's name, after the options of the scene file, which it
/// overrides. Throws InputError, one line that names the option (or file and line), the value and
/// what was expected.
[[nodiscard]] Options parse_options(const std::vector<std::string>& words);

/// Parses another command line for the scene of `given`, without reading the scene file again.
/// Throws InputError likewise.
[[nodiscard]] Options with_words(const Options& given, const std::vector<std::string>& words);

/// Name/value pairs of the options shown at `place`.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> option_values(Options options,
                                                                             OptionPlaces place);

/// Throws InputError unless requests to --serve may have this option.
void require_page_option(const std::string& name);

/// Name/value pairs, for the EXR, of all options that render the same picture of the same scene.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> picture_options(
    const Options& options, const Framing& framing);

}  // namespace raygate
