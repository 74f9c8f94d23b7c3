// SAH builder: splits primitives into a binary tree by the surface area heuristic (SAH).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "host/base/lanes.h"

namespace raygate {

/// A box: its low corner in lanes 0 to 2, its negated high corner in lanes 4 to 6. So the union of
/// two boxes is the minimum of each lane. Lanes 3 and 7 are not used.
using Box = FloatLanes;

RAYGATE_INLINE Box empty_box() { return Box{} + std::numeric_limits<float>::infinity(); }

RAYGATE_INLINE void grow(Box& box, const Box& other) { box = other < box ? other : box; }

/// Returns 1 / (longest side of the box). With this unit, half_area() is finite.
RAYGATE_INLINE float unit_of(const Box& box) {
  const float longest = -std::min({box[0] + box[4], box[1] + box[5], box[2] + box[6]});
  return std::min(1.0f / longest, std::numeric_limits<float>::max());
}

/// Returns half the surface area of a box that is not empty, with all lengths multiplied by `unit`.
RAYGATE_INLINE float half_area(const Box& box, float unit) {
  const FloatLanes sizes =
      unit * (box + __builtin_shufflevector(box, box, 4, 5, 6, 7, 0, 1, 2, 3));  // negated sizes
  return sizes[0] * sizes[1] + sizes[1] * sizes[2] + sizes[2] * sizes[0];
}

/// Returns corners' bounds, widened by a float on each side; finite for all but the largest float.
RAYGATE_INLINE Box box_around(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const Box corners[3] = {{a.x, a.y, a.z, 0.0f, -a.x, -a.y, -a.z, 0.0f},
                          {b.x, b.y, b.z, 0.0f, -b.x, -b.y, -b.z, 0.0f},
                          {c.x, c.y, c.z, 0.0f, -c.x, -c.y, -c.z, 0.0f}};
  Box box = corners[0];
  grow(box, corners[1]);
  grow(box, corners[2]);
  // The next float below: smaller bits for a positive float, larger bits for a negative one, and
  // the negative number of least magnitude for both zeros.
  const IntLanes bits = reinterpret_cast<IntLanes>(box);
  const IntLanes zero = (bits & 0x7FFFFFFF) == 0;
  const IntLanes below = bits + ((bits > 0) | 1);  // adds -1 to positive bits, 1 to others
  return reinterpret_cast<Box>(zero ? IntLanes{} + static_cast<std::int32_t>(0x80000001u) : below);
}

/// A primitive of a BinaryBvh: its box and a number that the caller assigns.
struct Primitive {
  float low[3];
  std::uint32_t number;
  float turned_high[3];
  std::uint32_t unused;

  Primitive() = default;
  RAYGATE_INLINE Primitive(const Box& box, std::uint32_t own_number) {
    std::memcpy(static_cast<void*>(this), &box, sizeof box);
    number = own_number;
  }

  [[nodiscard]] RAYGATE_INLINE Box box() const { return load<Box>(this); }
  /// Returns the box's centre along an axis. Halves both bounds first, so that the sum is finite.
  [[nodiscard]] RAYGATE_INLINE float middle(int axis) const {
    return 0.5f * low[axis] - 0.5f * turned_high[axis];
  }
};

/// A binary BVH with one primitive per leaf, split top-down by the surface area heuristic (Wald,
/// "On fast construction of SAH-based bounding volume hierarchies", 2007). A node covers a range of
/// `primitives`, which the builder reorders. The node whose range is split at index m is nodes[m],
/// so nodes are stored at the same index whichever thread builds them.
struct BinaryBvh {
  /// Index of a node, or size() plus the index of a leaf's primitive.
  using Ref = std::uint32_t;

  struct Node {
    Box box;
    Ref child[2];
    std::uint32_t first, count;  ///< range of primitives
  };

  /// Bounds are finite with a magnitude of at most 2^126; there are fewer than 2^31 primitives. The
  /// depth is at most `max_depth` (root: 0), or the depth of a balanced tree if this is larger.
  BinaryBvh(std::vector<Primitive> boxes, int max_depth, int threads);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(primitives.size()); }
  [[nodiscard]] bool is_leaf(Ref ref) const { return ref >= size(); }
  [[nodiscard]] RAYGATE_INLINE Box box(Ref ref) const {
    return load<Box>(is_leaf(ref) ? static_cast<const void*>(&primitives[ref - size()])
                                  : &nodes[ref].box);
  }
  [[nodiscard]] std::uint32_t first(Ref ref) const {
    return is_leaf(ref) ? ref - size() : nodes[ref].first;
  }
  [[nodiscard]] std::uint32_t count(Ref ref) const { return is_leaf(ref) ? 1 : nodes[ref].count; }
  /// Returns the root of a BVH that is not empty.
  [[nodiscard]] Ref root() const { return nodes[0].child[0]; }

  std::vector<Primitive> primitives;
  std::vector<Node> nodes;  ///< nodes[0] is the parent of the root
};

}  // namespace raygate
