// The values of options, from text.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "host/cli/option_text.h"
#include "host/cli/options.h"

namespace raygate {

/// Largest side of a frame in pixels, and largest number of pixels rendered in one run: the film
/// and its encodings then stay below about 5 GB.
inline constexpr int kMaxSide = 65536;
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;

// Each of these reads the value of one option and throws InputError if it is impossible.

struct Size {
  int width, height;
};
[[nodiscard]] Size parse_size(const std::string& text);             ///< "640x480"
[[nodiscard]] CameraSetting parse_camera(const std::string& text);  ///< "1,2,3,0,0,0,40"
/// "left", or azimuth and elevation: "33,24".
[[nodiscard]] std::pair<double, double> parse_view(const std::string& text);
[[nodiscard]] glm::dvec3 parse_axis(const std::string& text);            ///< "z", "-z"
[[nodiscard]] double parse_fov(const std::string& text);                 ///< "40"
[[nodiscard]] double parse_smooth(const std::string& text);              ///< "30"
[[nodiscard]] PixelRect parse_crop(const std::string& text, Size size);  ///< "10,10,20,20"
[[nodiscard]] std::uint64_t parse_seed(const std::string& text);         ///< "7"

}  // namespace raygate
