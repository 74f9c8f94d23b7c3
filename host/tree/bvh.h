// A tree of boxes around a scene's triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "host/scene/scene.h"
#include "host/vectors.h"

namespace raygate {

/// A tree of axis-aligned boxes, eight to a node. A leaf holds a run of slots; slot s stands for
/// triangle `triangle_of(s)` of the scene. The tree does not refer to the scene after it is built,
/// and is the same, byte for byte, whatever the number of threads that build it. Memory: 256 bytes
/// a node, a node for about five slots, and 41 bytes a slot.
class Bvh {
 public:
  static constexpr int kWidth = 8;
  static constexpr std::uint32_t kMaxLeafSize = 4;
  /// No way from the root to a leaf is longer.
  static constexpr int kMaxDepth = 48;
  /// What a walk's stack must hold: each level leaves at most seven children waiting.
  static constexpr int kStackSize = (kWidth - 1) * kMaxDepth + 1;

  /// An inner node or a leaf.
  struct Child {
    std::uint32_t first;  ///< inner: index of the node; leaf: the slots first .. first + count
    std::uint32_t count;  ///< 0: an inner node
  };

  /// Eight boxes against which one ray is tested at once. Boxes are one float wider than what they
  /// hold on every side; absent children, which come last, have empty ones, low = +infinity and
  /// high = -infinity.
  struct alignas(64) Node {
    float bounds[2][3][kWidth];  ///< [low = 0, high = 1][axis][child]
    Child child[kWidth];

    /// The low and the high corner of a child's box.
    [[nodiscard]] std::pair<glm::vec3, glm::vec3> box(int i) const {
      return {{bounds[0][0][i], bounds[0][1][i], bounds[0][2][i]},
              {bounds[1][0][i], bounds[1][1][i], bounds[1][2][i]}};
    }
  };

  /// The vertices of a slot's triangle, in the triangle's order.
  using Corners = std::array<glm::vec3, 3>;

  /// Builds the tree; all positions finite, of magnitude at most 2^126; fewer than 2^31 triangles.
  /// A scene without triangles gives a tree that no ray enters.
  explicit Bvh(const Scene& scene, int threads = 1);

  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }  ///< nodes()[0]: the root
  [[nodiscard]] std::uint32_t slot_count() const {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t slot) const { return triangles_[slot]; }

  [[nodiscard]] Corners corners_of(std::uint32_t slot) const {
    const Place place = places_[slot];
    const float* const from = &corners_[9 * std::size_t{slot - place.number} + place.number];
    Corners corners;
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) corners[v][k] = from[std::size_t(3 * v + k) * place.count];
    }
    return corners;
  }
  /// The corners of a leaf's triangles, one coordinate of all of them after the other: coordinate k
  /// of corner v of triangle i is [(3 v + k) count + i]. What comes after the last one may be read,
  /// and means nothing, as far as for four triangles.
  [[nodiscard]] const float* corners_of(const Child& leaf) const {
    return corners_.data() + 9 * std::size_t{leaf.first};
  }

  /// Says that a child will soon be visited. (Always inlined: GCC 12 takes a function that does
  /// nothing but prefetch for one without effect, and leaves its calls out.)
  RAYGATE_INLINE void prefetch(const Child& child) const {
    // Without a branch, which would be a guess about what kind of child it is.
    const auto* const corners = reinterpret_cast<const char*>(corners_of(child));
    const auto node = reinterpret_cast<std::uintptr_t>(nodes_.data() + child.first);
    const auto to_node =
        static_cast<std::ptrdiff_t>(node - reinterpret_cast<std::uintptr_t>(corners));
    const char* const begin = corners + (to_node & -std::ptrdiff_t{child.count == 0});
    for (std::ptrdiff_t line = 0; line < 4; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  friend class BvhWriter;

  /// Which of its leaf's triangles a slot is.
  struct Place {
    std::uint8_t number, count;
  };

  std::vector<Node> nodes_;
  std::vector<float> corners_;            // all geometry: leaf by leaf
  std::vector<std::uint32_t> triangles_;  // of the slots, as the places
  std::vector<Place> places_;
};

}  // namespace raygate
