// The ray core's camera unit in C++, bit for bit: directions through a grid of pixels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// The paper's equation 1: where the pixels of a picture lie, seen from the eye. Any length;
/// finite.
struct PixelGrid {
  glm::vec3 first{0.0f};  ///< through the middle of pixel (0, 0)
  glm::vec3 right{0.0f};  ///< from a pixel to the next of its row
  glm::vec3 down{0.0f};   ///< from a row to the next

  /// Through pixel (x, y): the largest component is in [1, 2), and what became smaller than 2^-126
  /// is zero. It means nothing where the sum is zero or not finite.
  [[nodiscard]] glm::vec3 direction(std::uint16_t x, std::uint16_t y) const;
};

}  // namespace raygate
