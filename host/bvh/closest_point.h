// Proximity queries: the closest point on the triangles, and the triangles near a box.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"
#include "host/bvh/traversal.h"
#include "host/exact/exact.h"

namespace raygate {

struct ClosestPoint {
  std::uint32_t primitive = 0;
  double distance = 0.0;
  glm::dvec3 point{0.0};
};

/// Returns the point of any triangle that is closest to `point`, computed in double with rounding
/// errors. Of triangles at equal distance, the one with the lower index in the scene is returned.
/// `point` must be finite, and the BVH must have a triangle.
[[nodiscard]] ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point);

/// Calls visit(leaf) for the leaves whose boxes touch the closed box from `low` to `high`, in any
/// order, until a call returns true. Returns whether a call did. Must be called within in_vectors.
template <Vectors kCode, class Visit>
RAYGATE_INLINE bool any_leaf_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                                  const Visit& visit) {
  const auto touching = [&](const Bvh::Node& node) RAYGATE_BODY {
    IntLanes touches = IntLanes{} - 1;
    for (int k = 0; k < 3; ++k) {
      const FloatLanes lows = load<FloatLanes>(node.bounds[0][k]),
                       highs = load<FloatLanes>(node.bounds[1][k]);
      touches &= (lows <= high[k]) & (highs >= low[k]);
    }
    return sign_mask<kCode>(touches);
  };
  return any_leaf(bvh, touching, visit);
}

/// Returns whether a triangle's axis-aligned box touches the closed box from `low` to `high`.
[[nodiscard]] inline bool touches(const glm::vec3& low, const glm::vec3& high, const Corners& t) {
  const glm::dvec3 least = glm::min(glm::min(t[0], t[1]), t[2]);
  const glm::dvec3 most = glm::max(glm::max(t[0], t[1]), t[2]);
  return glm::all(glm::lessThanEqual(least, glm::dvec3(high))) &&
         glm::all(glm::lessThanEqual(glm::dvec3(low), most));
}

/// Calls visit(primitive, corners) for the triangles whose axis-aligned boxes touch the closed box
/// from `low` to `high`, until a call returns true. Returns whether a call did.
template <class Visit>
[[nodiscard]] bool any_primitive_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                                      const Visit& visit) {
  return in_vectors([&](auto code) RAYGATE_BODY {
    const auto look = [&](const Bvh::Child& leaf) RAYGATE_BODY {
      for (std::uint32_t primitive = leaf.first; primitive < leaf.first + leaf.count; ++primitive) {
        const Corners t = bvh.corners_of(primitive);
        if (touches(low, high, t) && visit(primitive, t)) return true;
      }
      return false;
    };
    return any_leaf_near<code()>(bvh, low, high, look);
  });
}

}  // namespace raygate
