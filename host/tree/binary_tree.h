// How triangles are divided, two ways at a time: the plan of a tree.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "host/scene/scene.h"
#include "host/tree/box.h"
#include "host/tree/bvh.h"

namespace raygate {

/// A triangle and its grown box.
struct Primitive {
  float low[3];
  std::uint32_t triangle;
  float turned_high[3];
  std::uint32_t unused;

  RAYGATE_INLINE void get(Box& box) const { std::memcpy(&box, this, sizeof box); }
  /// The box's along an axis; halved before it is added up, so that it is finite.
  [[nodiscard]] RAYGATE_INLINE float middle(int axis) const {
    return 0.5f * low[axis] - 0.5f * turned_high[axis];
  }
};

/// A binary tree of boxes with one triangle to a leaf, split top-down by the surface area heuristic
/// (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007). Its nodes are
/// runs of `primitives`, which it has put in order; the node whose run is cut in two at m is
/// nodes[m]. So each thread knows where its nodes go, and the tree does not depend on which thread
/// made what.
struct BinaryTree {
  static constexpr int kMaxDepth = Bvh::kMaxDepth;  ///< of leaves; the root's is 0

  /// A node's number; from `size()` on: that of a leaf's primitive, plus size().
  using Ref = std::uint32_t;

  struct Node {
    Box box;
    Ref child[2];
    std::uint32_t first, count;  ///< the run
  };

  /// All positions finite, of magnitude at most 2^126; fewer than 2^31 triangles.
  BinaryTree(const Scene& scene, int threads);

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
  /// Of a tree that is not empty.
  [[nodiscard]] Ref root() const { return nodes[0].child[0]; }

  std::vector<Primitive> primitives;
  std::vector<Node> nodes;  ///< nodes[0] is above the root
};

}  // namespace raygate
