// A picture as a display shows it: 8 bits for each of red, green and blue.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/film/film.h"

namespace raygate {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< sRGB codes

/// Pixels of `window` within a `width` x `height` frame, row by row from the top.
struct Image8 {
  int width = 0, height = 0;
  PixelRect window;
  std::vector<Rgb8> pixels;
  std::vector<std::pair<std::string, std::string>> texts;  ///< what the file says of itself
};

}  // namespace raygate
