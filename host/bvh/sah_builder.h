// SAH builder: splits triangles into a binary tree by the surface area heuristic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "host/bvh/box.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace raygate {

/// The primitives of a BVH. Faces without area are skipped (see is_left_out).
struct TreeContent {
  /// An instance, which has a BVH of its own.
  struct Other {
    Box box;
    std::uint32_t root;  ///< node index of the root of its BVH
  };
  std::span<const glm::vec3> positions;
  std::span<const Triangle> triangles;
  std::vector<Other> others = {};

  [[nodiscard]] std::size_t size() const { return triangles.size() + others.size(); }
};

/// A triangle with its widened box or, if the index is beyond the last triangle, an instance.
struct Primitive {
  float low[3];
  std::uint32_t triangle;
  float turned_high[3];
  std::uint32_t unused;

  RAYGATE_INLINE void get(Box& box) const { std::memcpy(&box, this, sizeof box); }
  /// Returns the box's centre along an axis. Sides are halved first, so that the sum is finite.
  [[nodiscard]] RAYGATE_INLINE float middle(int axis) const {
    return 0.5f * low[axis] - 0.5f * turned_high[axis];
  }
};

/// A binary BVH with one triangle per leaf, split top-down by the surface area heuristic (Wald, "On
/// fast construction of SAH-based bounding volume hierarchies", 2007). A node covers a range of
/// `primitives`, which the builder sorts; the node whose range is split at m is nodes[m]. So each
/// thread knows where its nodes are stored, and the BVH does not depend on which thread builds a
/// part.
struct BinaryBvh {
  /// Index of a node, or size() plus the index of a leaf's primitive.
  using Ref = std::uint32_t;

  struct Node {
    Box box;
    Ref child[2];
    std::uint32_t first, count;  ///< range of primitives
  };

  /// All positions are finite with a magnitude of at most 2^126; there are fewer than 2^31
  /// primitives. No leaf is deeper than `max_depth` (the root's depth is 0), unless a balanced tree
  /// would be deeper.
  BinaryBvh(const TreeContent& content, int max_depth, int threads);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(primitives.size()); }
  [[nodiscard]] bool is_leaf(Ref ref) const { return ref >= size(); }
  RAYGATE_INLINE void get_box(Ref ref, Box& box) const {
    if (is_leaf(ref)) {
      primitives[ref - size()].get(box);
    } else {
      box = nodes[ref].box;
    }
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
