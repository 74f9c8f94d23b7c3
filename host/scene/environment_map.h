// Light from all around: a picture of all directions.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace raygate {

/// Radiance from where no geometry is, in place of a background: a latitude-longitude picture. Its
/// upper edge is straight up, its lower edge straight down; in its middle is what is ahead, to the
/// right of that what is on the right. Between the middles of texels it is bilinear; it goes on
/// from the right edge at the left one.
struct EnvironmentMap {
  int width = 0, height = 0;         ///< at least 1
  std::vector<glm::vec3> texels;     ///< row by row from the top; finite, none negative
  float strength = 1.0f;             ///< times the texels: radiance, scene-linear RGB
  glm::dvec3 up{0.0, 1.0, 0.0};      ///< where the picture's upper edge is; unit length
  glm::dvec3 ahead{0.0, 0.0, -1.0};  ///< and where its middle is; unit length, across `up`

  [[nodiscard]] const glm::vec3& texel(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

}  // namespace raygate
