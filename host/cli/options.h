// What the user asked for on the command line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "host/render/film.h"

namespace raygate {

/// Who tests rays against polygons.
enum class Engine {
  kRtl,    ///< the simulated hardware
  kCpu,    ///< its twin in C++
  kCheck,  ///< both, compared bit for bit
};

/// Where the camera stands and looks, in the scene file's coordinates.
struct CameraPlacement {
  glm::dvec3 eye{0.0};
  glm::dvec3 target{0.0};
  std::optional<double> fov;  ///< vertical field of view in degrees, (0, 180); none: the default
};

/// Checked options: every value is possible. Whether files can be read or written is not checked.
struct Options {
  /// Text that --help or --version asked for; if not empty nothing else here is of use.
  std::string information;

  std::filesystem::path scene;
  std::optional<std::filesystem::path> exr;  ///< at least one of the two pictures is there
  std::optional<std::filesystem::path> png;
  std::optional<std::filesystem::path> stats;  ///< run statistics as JSON
  int width = 640, height = 480;               ///< of the whole frame, in pixels
  PixelRect window;                            ///< to be rendered: the frame or --crop
  Engine engine = Engine::kRtl;
  std::string unit = "pipeline";  ///< or "serial"
  int lanes = 1;                  ///< of the pipelined unit: 1, 2, 4 or 8; 1 for the serial one
  unsigned threads = 1;
  std::optional<CameraPlacement> camera;  ///< none: framed on the scene
  std::uint64_t seed = 0;
  bool quiet = false;
  bool skip_degenerate = false;
};

/// Reads the command line of `main`. Throws InputError, one line that names the option, what was
/// given and what is allowed.
[[nodiscard]] Options parse_options(int argc, const char* const* argv);

/// "rtl", "cpu" or "check".
[[nodiscard]] std::string to_string(Engine engine);

}  // namespace raygate
