// Bvh: an eight-wide bounding volume hierarchy around a scene's triangles and instances.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "host/base/vectors.h"
#include "host/bvh/sah_builder.h"
#include "host/scene/instances.h"
#include "host/scene/scene.h"

namespace raygate {

struct TreeContent;

/// Its nodes and primitives are those of the mesh's tree, of numbers from `first_node` and
/// `first_primitive` on.
struct InstanceBvh {
  double rows[3][4];      ///< as Instance has them
  float matrix[3][3];     ///< the first three of each
  float low[3], high[3];  ///< about the fourth: what bounds begin with
  std::uint32_t mesh;     ///< whose tree it is
  std::uint32_t first_node = 0, first_primitive = 0;
  std::uint32_t first_triangle = 0;  ///< in the scene

  /// `size`: the largest magnitudes of the bounds of the mesh's tree.
  InstanceBvh(const Instance& instance, const glm::dvec3& size);
};

/// A tree of axis-aligned boxes, eight to a node. A leaf holds a run of primitives; primitive s
/// stands for triangle `triangle_of(s)` of the scene. The tree does not refer to the scene after it
/// is built, and is the same, byte for byte, whatever the number of threads that build it. Memory:
/// 320 bytes a node, a node for about five primitives, and 41 bytes a primitive.
///
/// Of a mesh that stands in several places there is one tree. What is below an instance looks like
/// any other part of the tree, with nodes and primitives of numbers that nothing is stored for:
/// BvhView and corners_of() make them out of the mesh's when they are asked for: instance_bvh.cpp
/// says how. An instance takes some 200 bytes.
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
    std::uint32_t first;  ///< inner: index of the node; leaf: the primitives first .. first + count
    std::uint32_t count;  ///< 0: an inner node

    /// The last kind, of more triangles than a leaf may have, is what a walk ends with.
    enum Kind : std::size_t { kInner, kLeaf, kNone, kKinds };
    [[nodiscard]] std::size_t kind() const { return (count + kMaxLeafSize - 1) / kMaxLeafSize; }
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

  /// The vertices of a primitive's triangle, in the triangle's order.
  using Corners = std::array<glm::vec3, 3>;

  /// Where the corners of a leaf's triangles are made, if they are not stored.
  struct LeafRoom {
    float corners[9 * kMaxLeafSize + kMaxLeafSize];
  };

  /// Builds the tree; all positions finite, of magnitude at most 2^126, those of instances too, and
  /// so are sums of their rows' magnitudes times positions; fewer than 2^31 triangles. A scene
  /// without triangles gives a tree that no ray enters.
  explicit Bvh(const Scene& scene, int threads = 1);

  /// Those that are stored, of no instance; nodes()[0] is the root.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }

  /// The primitives below are those that are stored, of no instance.
  [[nodiscard]] std::uint32_t primitive_count() const {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] bool has_instances() const { return !instances_.empty(); }
  /// The primitives of all instances: first .. second; after the stored ones.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> instance_primitives() const {
    if (!has_instances()) return {primitive_count(), primitive_count()};
    return {instance_primitives_.begin(), instance_primitives_.end()};
  }
  /// Whether the number of a primitive, or of a node, is one of an instance.
  [[nodiscard]] RAYGATE_INLINE bool is_instanced(std::uint32_t number) const {
    return number >= first_instanced_;
  }
  /// The leaves of the whole tree.
  [[nodiscard]] std::vector<Child> leaves() const;
  /// Of the whole tree, instances included.
  [[nodiscard]] std::uint64_t triangle_count() const {
    return std::uint64_t{primitive_count()} +
           (instance_primitives_.end() - instance_primitives_.begin());
  }

  /// The number of a primitive's triangle in the scene.
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t primitive) const {
    return is_instanced(primitive) ? instance_triangle(primitive) : triangles_[primitive];
  }
  /// Where the scene stores it.
  [[nodiscard]] RAYGATE_INLINE FaceRef face_of(std::uint32_t primitive) const {
    if (is_instanced(primitive)) [[unlikely]]
      return instance_face(primitive);
    return {kNoIndex, triangles_[primitive]};
  }

  [[nodiscard]] Corners corners_of(std::uint32_t primitive) const {
    if (is_instanced(primitive)) [[unlikely]]
      return instance_corners(primitive);
    return stored_corners(primitive);
  }

 private:
  friend class BvhWriter;
  friend class BvhView;

  Bvh() = default;

  /// Builds it, of at most so many levels.
  void build(const TreeContent& content, int most_levels, int threads);
  /// Takes the scene's instances in, adds them to the content, and says how many levels they have.
  int add_instances(const Scene& scene, int threads, TreeContent& content);
  /// How many nodes there are on the longest way down.
  [[nodiscard]] int levels(std::uint32_t index = 0) const;

  void make_instance_node(std::uint32_t index, Node& room) const;
  void make_instance_corners(const Child& leaf, LeafRoom& room) const;
  [[nodiscard]] Corners instance_corners(std::uint32_t primitive) const;
  [[nodiscard]] std::uint32_t instance_triangle(std::uint32_t primitive) const;
  [[nodiscard]] FaceRef instance_face(std::uint32_t primitive) const;
  void prefetch_instance(const Child& child) const;

  [[nodiscard]] Corners stored_corners(std::uint32_t primitive) const {
    const Place place = places_[primitive];
    const float* const from = &corners_[9 * std::size_t{primitive - place.number} + place.number];
    Corners corners;
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) corners[v][k] = from[std::size_t(3 * v + k) * place.count];
    }
    return corners;
  }

  /// Which of its leaf's triangles a primitive is.
  struct Place {
    std::uint8_t number, count;
  };

  std::vector<Node> nodes_;
  std::vector<float> corners_;            // all geometry: leaf by leaf
  std::vector<std::uint32_t> triangles_;  // of the primitives, as the places
  std::vector<Place> places_;

  // Nodes and primitives from here on are of instances: `instance_nodes_` and
  // `instance_primitives_` say of which.
  std::uint32_t first_instanced_ = 0xFFFFFFFF;
  RangeMap instance_nodes_, instance_primitives_;
  std::vector<InstanceBvh> instances_;
  std::vector<Bvh> meshes_;
};

}  // namespace raygate
