// Closest point: the point of a scene's triangles that is nearest to a given one.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/bvh/bvh.h"

namespace raygate {

struct ClosestPoint {
  std::uint32_t primitive = 0;
  double distance = 0.0;
  glm::dvec3 point{0.0};
};

/// Returns the nearest point to a finite point; errors are those of rounding in double. Of
/// triangles at the same distance the one of the lowest number is returned. The tree must have a
/// triangle.
[[nodiscard]] ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point);

}  // namespace raygate
