// Numbers of lights, as floats hold them.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

namespace raygate {

[[nodiscard]] inline double mean(const glm::dvec3& colour) {
  return (colour.x + colour.y + colour.z) / 3.0;
}

/// A float that is no infinity.
[[nodiscard]] inline float finite_float(double x) {
  return static_cast<float>(std::min(x, double{std::numeric_limits<float>::max()}));
}
[[nodiscard]] inline glm::vec3 finite_floats(const glm::dvec3& x) {
  return {finite_float(x.x), finite_float(x.y), finite_float(x.z)};
}

}  // namespace raygate
