// Closest point: of a scene's triangles, the point that is nearest to a given one.
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

/// For a finite point, in double: off by its rounding. Of triangles at the same distance the one of
/// the lower number. The tree has a triangle.
[[nodiscard]] ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point);

}  // namespace raygate
