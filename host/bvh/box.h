// Box: an axis-aligned bounding box in one register, for building BVHs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "host/base/lanes.h"

namespace raygate {

/// The low corner in lanes 0 to 2, the negated high corner in lanes 4 to 6: the union of two boxes
/// is the minimum of each lane. Lanes 3 and 7 are not used.
using Box = FloatLanes;

/// Makes the box empty.
RAYGATE_INLINE void clear(Box& box) { box = FloatLanes{} + std::numeric_limits<float>::infinity(); }

RAYGATE_INLINE void grow(Box& box, const Box& other) { box = other < box ? other : box; }

/// Returns 1 / (longest side of the box), a unit in which areas are finite.
RAYGATE_INLINE float unit_of(const Box& box) {
  const float longest = -std::min({box[0] + box[4], box[1] + box[5], box[2] + box[6]});
  return std::min(1.0f / longest, std::numeric_limits<float>::max());
}

/// Returns half the surface area of a box that is not empty, with all lengths multiplied by `unit`.
RAYGATE_INLINE float half_area(const Box& box, float unit) {
  const FloatLanes sizes =
      unit * (box + __builtin_shufflevector(box, box, 4, 5, 6, 7, 0, 1, 2, 3));  // negative
  return sizes[0] * sizes[1] + sizes[1] * sizes[2] + sizes[2] * sizes[0];
}

/// Sets `box` to the bounds of three corners, widened by one float on every side. Finite for
/// coordinates below the largest float.
RAYGATE_INLINE void box_around(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                               Box& box) {
  const Box corners[3] = {{a.x, a.y, a.z, 0.0f, -a.x, -a.y, -a.z, 0.0f},
                          {b.x, b.y, b.z, 0.0f, -b.x, -b.y, -b.z, 0.0f},
                          {c.x, c.y, c.z, 0.0f, -c.x, -c.y, -c.z, 0.0f}};
  box = corners[0];
  grow(box, corners[1]);
  grow(box, corners[2]);
  // The next float below: smaller bits for a positive float, larger bits for a negative one, and
  // the smallest negative number for both zeros.
  const IntLanes bits = reinterpret_cast<IntLanes>(box);
  const IntLanes zero = (bits & 0x7FFFFFFF) == 0;
  const IntLanes below = bits + ((bits > 0) | 1);  // -1 where positive: no lane overflows
  box = reinterpret_cast<FloatLanes>(zero ? IntLanes{} + static_cast<std::int32_t>(0x80000001u)
                                          : below);
}

}  // namespace raygate
