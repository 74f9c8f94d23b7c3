// Directions given by their angles around another one.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace raygate {

/// The unit vector at the angle with `cosine` to the unit vector `axis`, turned by `turn` radians
/// around it.
[[nodiscard]] inline glm::dvec3 around(const glm::dvec3& axis, double cosine, double turn) {
  // The axis' smallest component says which direction is far from it.
  const glm::dvec3 size = glm::abs(axis);
  const glm::dvec3 far = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                         : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                              : glm::dvec3(0, 0, 1);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, far)), v = glm::cross(axis, u);
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return cosine * axis + sine * (std::cos(turn) * u + std::sin(turn) * v);
}

}  // namespace raygate
