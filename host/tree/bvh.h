// A tree of boxes around a scene's triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "host/scene/scene.h"

namespace raygate {

class WideBvh;

/// A binary tree of axis-aligned boxes, split by the surface area heuristic. A leaf holds a run of
/// slots; slot s stands for triangle `triangle_of(s)` of the scene. The tree does not refer to the
/// scene after it is built. Memory: 64 bytes an inner node, 40 bytes a slot, and about 80 bytes an
/// inner node for the same tree with eight children to a node.
class Bvh {
 public:
  /// The larger a leaf, the fewer boxes and the more hit tests.
  static constexpr std::uint32_t kMaxLeafSize = 4;
  /// No path from the root is longer: what a traversal's stack must hold.
  static constexpr int kMaxDepth = 60;

  /// A child: an inner node (count = 0) or a leaf.
  struct Ref {
    std::uint32_t first;  ///< inner: index of the node; leaf: the slots first .. first + count
    std::uint16_t count;
    std::uint16_t axis;  ///< inner: its child 0 is the lower one along this axis (a hint)
  };

  /// Both children with their boxes, one cache line. Boxes are one float wider than what they
  /// hold on every side. An absent child (a scene of one leaf or none) has an empty box,
  /// low = +infinity and high = -infinity.
  struct alignas(64) Node {
    glm::vec3 bounds[2][2];  ///< [low = 0, high = 1][child]
    Ref child[2];
  };

  /// The vertices of a slot's triangle, in the triangle's order.
  using Corners = std::array<glm::vec3, 3>;

  /// Builds the tree; all positions finite, of magnitude at most 2^126. A scene without triangles
  /// gives a tree that no ray enters.
  explicit Bvh(const Scene& scene);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
  [[nodiscard]] Ref root() const { return root_; }              ///< an inner node, always
  [[nodiscard]] const WideBvh& wide() const { return *wide_; }  ///< the same leaves
  [[nodiscard]] std::uint32_t slot_count() const {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t slot) const { return triangles_[slot]; }
  [[nodiscard]] const Corners& corners_of(std::uint32_t slot) const { return corners_[slot]; }
  /// Of the slots first .. first + count.
  [[nodiscard]] std::span<const Corners> corners_of(std::uint32_t first,
                                                    std::uint32_t count) const {
    return std::span(corners_).subspan(first, count);
  }
  /// Says that the corners of a few slots from there on will soon be asked for.
  void prefetch(std::uint32_t first) const {
    const auto* const begin = reinterpret_cast<const char*>(&corners_[first]);
    for (std::ptrdiff_t line = 0; line < 3; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  friend class BvhBuilder;

  std::vector<Node> nodes_;
  Ref root_{};
  std::vector<std::uint32_t> triangles_;
  std::vector<Corners> corners_;
  std::shared_ptr<const WideBvh> wide_;
};

}  // namespace raygate
