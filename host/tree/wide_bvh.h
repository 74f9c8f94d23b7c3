// The tree of boxes once more, with eight children to a node: for one beam against eight boxes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/tree/bvh.h"

namespace raygate {

/// A Bvh whose nodes have taken in the children of their largest children, until there are eight.
/// Slots and boxes are those of the binary tree, which must outlive this one's making only.
/// Memory: 256 bytes a node, a node for each three or four inner nodes of the binary tree, and 36
/// bytes a slot.
class WideBvh {
 public:
  static constexpr int kWidth = 8;
  /// Two sibling leaves that are no larger together, and about as near to each other as they are
  /// large, are one leaf here.
  static constexpr std::uint32_t kMaxLeafSize = 4;
  /// What a traversal's stack must hold: each level leaves at most seven children waiting.
  static constexpr int kStackSize = (kWidth - 1) * Bvh::kMaxDepth + kWidth;

  struct Child {
    std::uint32_t first;  ///< inner: index of the node; leaf: the slots first .. first + count
    std::uint32_t count;  ///< 0: an inner node
  };

  /// Absent children have empty boxes, low = +infinity and high = -infinity.
  struct alignas(64) Node {
    float bounds[2][3][kWidth];  ///< [low = 0, high = 1][axis][child]
    Child child[kWidth];
  };

  /// The root is nodes()[0].
  explicit WideBvh(const Bvh& bvh);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }

  /// The corners of a leaf's triangles, one coordinate of all of them after the other: coordinate k
  /// of corner v of triangle i is [(3 v + k) count + i]. What comes after the last one may be read,
  /// and means nothing, as far as for four triangles.
  [[nodiscard]] const float* corners_of(const Child& leaf) const {
    return corners_.data() + 9 * std::size_t{leaf.first};
  }

  /// Says that a child will soon be visited.
  void prefetch(const Child& child) const {
    const auto* const begin = child.count == 0 ? reinterpret_cast<const char*>(&nodes_[child.first])
                                               : reinterpret_cast<const char*>(corners_of(child));
    for (std::ptrdiff_t line = 0; line < 4; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  void fill(std::uint32_t index, const Bvh& bvh, const Bvh::Node& from);
  void fill_corners(const Bvh& bvh, const Child& leaf);

  std::vector<Node> nodes_;
  std::vector<float> corners_;
};

}  // namespace raygate
