#include "host/intersect/core/pixel_grid.h"

#include <algorithm>
#include <bit>

// The steps are those of hw/ray_core/ray_generator.sv.

namespace raygate {

glm::vec3 PixelGrid::direction(std::uint16_t x, std::uint16_t y) const {
  glm::vec3 way = first + static_cast<float>(y) * down;
  way = way + static_cast<float>(x) * right;
  const auto field = [&](int k) { return std::bit_cast<std::uint32_t>(way[k]) >> 23 & 0xFF; };
  const std::uint32_t largest = std::max({field(0), field(1), field(2)});
  for (int k = 0; k < 3; ++k) {
    const auto word = std::bit_cast<std::uint32_t>(way[k]);
    const std::uint32_t below = largest - field(k);
    const bool zero = field(k) == 0 || below > 126;
    way[k] = std::bit_cast<float>((word & 0x80000000u) |
                                  (zero ? 0u : (127 - below) << 23 | (word & 0x7FFFFF)));
  }
  return way;
}

}  // namespace raygate
