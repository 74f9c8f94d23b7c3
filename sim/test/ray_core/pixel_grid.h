// Reference model of the ray core's ray generator, bit for bit.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// Pixels of a picture relative to the eye: the paper's equation 1. Vectors may be of any length.
struct PixelGrid {
  glm::vec3 first{0.0f};  ///< from the eye to the middle of pixel (0, 0)
  glm::vec3 right{0.0f};  ///< from a pixel to the next pixel in its row
  glm::vec3 down{0.0f};   ///< from a row to the next row

  /// Returns the direction through pixel (x, y), scaled so that its largest magnitude is in [1, 2).
  /// Scaled components below 2^-126 become zero. Zero or non-finite directions are not scaled.
  [[nodiscard]] glm::vec3 direction(std::uint16_t x, std::uint16_t y) const;
};

// Uses the operations of hw/ray_core/ray_generator.sv in the same order.
inline glm::vec3 PixelGrid::direction(std::uint16_t x, std::uint16_t y) const {
  glm::vec3 way = first + static_cast<float>(y) * down;
  way = way + static_cast<float>(x) * right;
  const auto field = [&](int k) { return std::bit_cast<std::uint32_t>(way[k]) >> 23 & 0xFF; };
  const std::uint32_t largest = std::max({field(0), field(1), field(2)});
  const std::uint32_t unit = largest == 255 ? 255 : 127;
  for (int k = 0; k < 3; ++k) {
    const auto word = std::bit_cast<std::uint32_t>(way[k]);
    const std::uint32_t below = largest - field(k);
    const bool zero = field(k) == 0 || below > 126;
    way[k] = std::bit_cast<float>((word & 0x80000000u) |
                                  (zero ? 0u : (unit - below) << 23 | (word & 0x7FFFFF)));
  }
  return way;
}

}  // namespace raygate
