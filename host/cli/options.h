// Options: what the user of ./render asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/camera_options.h"
#include "host/cli/engines.h"
#include "host/cli/output_options.h"
#include "host/options/light_options.h"
#include "host/scene/io/scene_file.h"

namespace raygate {

/// Checked options: every value is possible. Whether files can be read or written is not checked.
struct Options : EngineOptions {
  /// Text that --help or --version asked for; if not empty nothing else here is of use.
  std::string information;

  std::vector<std::string> words;       ///< as they were typed, without the program's name
  std::filesystem::path scene;          ///< as it was named: an OBJ or a scene file
  std::optional<SceneFile> scene_file;  ///< named, or found beside the OBJ
  RenderOptions render;                 ///< but for threads, channels and what one picture has
  CameraOptions camera;
  std::optional<EnvironmentSetting> environment;
  OutputOptions output;
  CoreFileOptions core_files;
  std::filesystem::path resume;  ///< a picture to resume; empty: none
  bool serve = false;            ///< the scene in a page, in place of files
  int port = 0;                  ///< of that page; 0: any that is free
  bool quiet = false, verbose = false;
  bool strict = false;           ///< faces without area are refused
  std::optional<double> smooth;  ///< degrees, as LoadOptions has it
  bool is_bare_model = false;    ///< there is no scene file, not even an ignored one

  [[nodiscard]] const std::filesystem::path& obj() const {
    return scene_file ? scene_file->obj : scene;
  }
};

/// Reads the command line of `main`, and before it the scene file's options, if there is one: the
/// command line has the last word. There are so many `processors`; 0: the machine's. Throws
/// InputError, one line that names the option (or the file and the line), what was given and what
/// is allowed.
[[nodiscard]] Options parse_options(int argc, const char* const* argv, unsigned processors = 0);

/// The options that are written at `place`, and their values.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> option_values(Options options,
                                                                             OptionPlaces place);

}  // namespace raygate
