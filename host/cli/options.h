// What the user asked for on the command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/core_files.h"
#include "host/cli/engine_options.h"
#include "host/cli/light_options.h"
#include "host/cli/output_options.h"
#include "host/film/film.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_file.h"

namespace raygate {

/// From where the whole scene is seen, and what changes a camera that is given.
struct ViewOptions {
  /// Azimuth and elevation in degrees: the scene from there, whatever cameras there are.
  std::optional<std::pair<double, double>> angles;
  std::optional<glm::dvec3> up;
  std::optional<double> fov;
  LensSetting lens;
};

/// Checked options: every value is possible. Whether files can be read or written is not checked.
struct Options : EngineOptions {
  /// Text that --help or --version asked for; if not empty nothing else here is of use.
  std::string information;

  std::filesystem::path scene;          ///< as it was named: an OBJ or a scene file
  std::optional<SceneFile> scene_file;  ///< named, or found beside the OBJ
  OutputOptions output;
  CoreFileOptions core_files;
  int width = 640, height = 480;        ///< of the whole frame, in pixels
  PixelRect window;                     ///< to be rendered: the frame or --crop
  std::optional<CameraSetting> camera;  ///< in the file's coordinates; none: its own, or a view
  ViewOptions view;                     ///< what changes it, or the view
  std::optional<bool> ground;           ///< none: where a first look needs it
  std::vector<CameraSetting> path;      ///< of --frames; empty: once round the target
  std::optional<EnvironmentSetting> environment;
  LightOptions light;
  std::filesystem::path resume;  ///< a picture to go on from; empty: none
  std::uint64_t seed = 0;
  bool quiet = false, verbose = false;
  bool strict = false;           ///< faces without area are refused
  std::optional<double> smooth;  ///< degrees, as LoadOptions has it

  [[nodiscard]] const std::filesystem::path& obj() const {
    return scene_file ? scene_file->obj : scene;
  }
};

/// Reads the command line of `main`, and before it the scene file's options, if there is one: the
/// command line has the last word. There are
/// so many `processors`; 0: the machine's. Throws InputError, one line that names the option (or
/// the file and the line), what was given and what is allowed.
[[nodiscard]] Options parse_options(int argc, const char* const* argv, unsigned processors = 0);

}  // namespace raygate
