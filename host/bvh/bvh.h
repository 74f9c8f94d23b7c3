// BVH: an eight-wide bounding volume hierarchy of a scene's triangles and instances.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "host/base/vectors.h"
#include "host/exact/exact.h"
#include "host/scene/instances.h"
#include "host/scene/scene.h"

namespace raygate {

/// Consecutive non-empty ranges of numbers. Finding the range of a number takes one table lookup if
/// the ranges have similar lengths.
class RangeMap {
 public:
  RangeMap() = default;
  /// Makes successive ranges of these lengths, starting at `begin`. The last one ends below 2^32.
  RangeMap(std::uint32_t begin, const std::vector<std::uint32_t>& lengths) : begins_{begin} {
    begins_.reserve(lengths.size() + 1);
    for (const std::uint32_t length : lengths) begins_.push_back(begins_.back() + length);
    if (lengths.empty()) return;
    const std::uint32_t size = end() - begin;
    shift_ = std::bit_width(size / static_cast<std::uint32_t>(lengths.size()));
    for (std::uint32_t chunk = 0, run = 0; chunk <= (size - 1) >> shift_; ++chunk) {
      while (begins_[run + 1] - begin <= chunk << shift_) ++run;
      first_.push_back(run);
    }
    first_.push_back(static_cast<std::uint32_t>(lengths.size() - 1));
  }

  [[nodiscard]] std::uint32_t begin() const { return begins_.front(); }
  [[nodiscard]] std::uint32_t end() const { return begins_.back(); }
  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const { return begins_[run]; }

  /// Returns the index of the range that contains `number`, in [begin(), end()).
  [[nodiscard]] std::uint32_t find(std::uint32_t number) const {
    const std::uint32_t* const chunk = &first_[(number - begins_[0]) >> shift_];
    const auto first = begins_.begin() + chunk[0] + 1, last = begins_.begin() + chunk[1] + 1;
    return static_cast<std::uint32_t>(std::upper_bound(first, last, number) - begins_.begin()) - 1;
  }

 private:
  std::vector<std::uint32_t> begins_{0};  // start of each range, and the end
  // For each chunk of 2^shift_ numbers, the range in which it begins; then the index of the last.
  std::vector<std::uint32_t> first_;
  int shift_ = 0;
};

/// An instance of a mesh. It shares the mesh's BVH: node and primitive i of that BVH have number
/// `first` + i here.
struct InstanceBvh {
  double rows[3][4];      ///< the transform, as in Instance
  float matrix[3][3];     ///< linear part of the transform, rounded
  float low[3], high[3];  ///< translation -+ e; e is defined in instance_bvh.cpp
  std::uint32_t mesh;     ///< index of the mesh's BVH
  std::uint32_t first = 0;
  std::uint32_t first_triangle = 0;  ///< index in the scene of the instance's first triangle

  /// `size`: the largest magnitudes of the bounds of the mesh's BVH, by axis.
  InstanceBvh(const Instance& instance, const glm::dvec3& size);
};

/// A BVH with eight children per node. A leaf holds a range of primitives; primitive i is triangle
/// `triangle_of(i)` of the scene. The BVH is the same, byte for byte, for any number of building
/// threads. If the scene has rests (see rest_of), the BVH refers to its rests and triangles.
/// Memory: 320 bytes per node, one node for about five primitives, and 41 bytes per primitive.
///
/// A mesh with several instances has one BVH. The nodes and primitives below an instance have
/// indices of their own but are not stored: BvhView and corners_of() compute them from the mesh's
/// BVH on access (instance_bvh.cpp). An instance takes about 200 bytes.
class Bvh {
 public:
  static constexpr int kWidth = 8;
  static constexpr std::uint32_t kMaxLeafSize = 4;
  /// Maximum number of nodes on a path from the root to a leaf.
  static constexpr int kMaxDepth = 48;
  /// Entries of a traversal's stack: each level leaves at most seven children to visit.
  static constexpr int kStackSize = (kWidth - 1) * kMaxDepth + 1;

  /// An inner node or a leaf.
  struct Child {
    std::uint32_t first;  ///< index of an inner node, or of a leaf's first primitive
    std::uint32_t count;  ///< number of a leaf's primitives; 0: an inner node

    /// kNone marks the end of a traversal; `count` is then more than kMaxLeafSize.
    enum Kind : std::size_t { kInner, kLeaf, kNone, kKinds };
    [[nodiscard]] std::size_t kind() const { return (count + kMaxLeafSize - 1) / kMaxLeafSize; }
  };

  /// Eight boxes that are tested against a ray at once. Each is one float wider than its contents
  /// on every side. Absent children come last; their boxes have low = +infinity, high = -infinity.
  struct alignas(64) Node {
    float bounds[2][3][kWidth];  ///< [low = 0, high = 1][axis][child]
    Child child[kWidth];

    /// Returns the low and the high corner of a child's box.
    [[nodiscard]] std::pair<glm::vec3, glm::vec3> box(int i) const {
      return {{bounds[0][0][i], bounds[0][1][i], bounds[0][2][i]},
              {bounds[1][0][i], bounds[1][1][i], bounds[1][2][i]}};
    }
    /// Returns the low and the high corner of the box around all children.
    [[nodiscard]] std::pair<glm::vec3, glm::vec3> box() const {
      auto [low, high] = box(0);
      for (int i = 1; i < kWidth; ++i) {
        low = glm::min(low, box(i).first);
        high = glm::max(high, box(i).second);
      }
      return {low, high};
    }
  };

  /// Buffer for the corners of the triangles of an instance's leaf.
  struct LeafRoom {
    float corners[9 * kMaxLeafSize + kMaxLeafSize];
  };

  /// Builds the BVH of fewer than 2^31 triangles. Positions are finite with a magnitude of at most
  /// 2^126. For a coordinate that an instance transforms, this limit holds for the sum of the
  /// magnitudes of its terms. A scene with rests must outlive the BVH.
  explicit Bvh(const Scene& scene, int threads = 1);

  /// Returns the stored nodes, without those of instances; nodes()[0] is the root.
  [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }

  /// Returns the number of stored primitives, without those of instances.
  [[nodiscard]] std::uint32_t primitive_count() const {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] bool has_instances() const { return !instances_.empty(); }
  /// Returns whether a primitive or node index belongs to an instance.
  [[nodiscard]] RAYGATE_INLINE bool is_instanced(std::uint32_t number) const {
    return number >= first_instanced_;
  }
  /// Returns the number of triangles, including those of instances.
  [[nodiscard]] std::uint64_t triangle_count() const {
    return std::uint64_t{primitive_count()} + (instance_numbers_.end() - instance_numbers_.begin());
  }

  /// Returns the scene's index of a primitive's triangle.
  [[nodiscard]] std::uint32_t triangle_of(std::uint32_t primitive) const {
    return is_instanced(primitive) ? instance_triangle(primitive) : triangles_[primitive];
  }
  /// Returns the scene's reference to a primitive's triangle.
  [[nodiscard]] RAYGATE_INLINE FaceRef face_of(std::uint32_t primitive) const {
    if (is_instanced(primitive)) [[unlikely]]
      return instance_face(primitive);
    return {kNoIndex, triangles_[primitive]};
  }

  /// Returns whether all corners are in binary32.
  [[nodiscard]] bool is_binary32() const { return rests_.empty(); }
  /// Returns the vertices of a primitive's triangle, in the triangle's order, rounded to binary32.
  [[nodiscard]] FloatCorners float_corners_of(std::uint32_t primitive) const {
    if (is_instanced(primitive)) [[unlikely]]
      return instance_corners(primitive);
    return stored_corners(primitive);
  }
  /// Returns the vertices of a primitive's triangle as in the scene, including rests.
  [[nodiscard]] Corners corners_of(std::uint32_t primitive) const {
    Corners corners = widened(float_corners_of(primitive));
    if (!is_binary32() && !is_instanced(primitive)) add_rests(triangles_[primitive], corners);
    return corners;
  }
  /// Prefetches what corners_of() reads. Needs three calls, with step 0, 1 and 2.
  RAYGATE_INLINE void prefetch_rests(std::uint32_t primitive, int step) const {
    if (is_binary32() || is_instanced(primitive)) return;
    const std::uint32_t& triangle = triangles_[primitive];
    if (step == 0) {
      __builtin_prefetch(&triangle);
    } else if (step == 1) {
      __builtin_prefetch(&faces_[triangle]);
    } else {
      for (const std::uint32_t vertex : faces_[triangle].vertices) {
        if (vertex < rests_.size()) __builtin_prefetch(&rests_[vertex]);
      }
    }
  }

 private:
  friend class BvhWriter;
  friend class BvhView;

  Bvh() = default;

  /// Builds the BVH of these triangles and of the instances, with at most `most_levels` levels.
  void build(std::span<const glm::vec3> positions, std::span<const Triangle> triangles,
             int most_levels, int threads);
  /// Builds the BVHs of meshes and adds the instances. Returns the most levels below an instance.
  int add_instances(const Scene& scene, int threads);
  /// Returns the number of nodes on the longest path down from a node.
  [[nodiscard]] int levels(std::uint32_t index = 0) const;

  [[nodiscard]] const InstanceBvh& instance_of(std::uint32_t number) const {
    return instances_[instance_numbers_.find(number)];
  }
  void make_instance_node(std::uint32_t index, Node& room) const;
  void make_instance_corners(const Child& leaf, LeafRoom& room) const;
  [[nodiscard]] FloatCorners instance_corners(std::uint32_t primitive) const;
  [[nodiscard]] std::uint32_t instance_triangle(std::uint32_t primitive) const;
  [[nodiscard]] FaceRef instance_face(std::uint32_t primitive) const;
  void prefetch_instance(const Child& child) const;

  void add_rests(std::uint32_t triangle, Corners& corners) const;

  [[nodiscard]] FloatCorners stored_corners(std::uint32_t primitive) const {
    const Place place = places_[primitive];
    const float* const from = &corners_[9 * std::size_t{primitive - place.number} + place.number];
    FloatCorners corners;
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) corners[v][k] = from[std::size_t(3 * v + k) * place.count];
    }
    return corners;
  }

  /// A primitive's index within its leaf, and the leaf's number of triangles.
  struct Place {
    std::uint8_t number, count;
  };

  std::vector<Node> nodes_;
  std::vector<float> corners_;            // corners of all primitives, leaf by leaf
  std::vector<std::uint32_t> triangles_;  // index in the scene, by primitive
  std::vector<Place> places_;
  std::span<const glm::ivec3> rests_;  // the scene's rests, or none
  std::span<const Triangle> faces_;    // the scene's triangles

  // Node and primitive indices from this one on belong to instances. Each instance has as many
  // indices as its mesh has primitives. A mesh has no more nodes than primitives.
  std::uint32_t first_instanced_ = 0xFFFFFFFF;
  RangeMap instance_numbers_;
  std::vector<InstanceBvh> instances_;
  std::vector<Bvh> meshes_;
};

/// A view of the nodes and leaves of a Bvh, which must outlive the view and not move. Hold a view
/// by value: through a reference, compilers load its pointers again after each store.
class BvhView {
 public:
  explicit BvhView(const Bvh& bvh)
      : bvh_(&bvh),
        places_{{bvh.nodes_.data(), sizeof(Bvh::Node)},
                {bvh.corners_.data(), kCornerBytes},
                {bvh.corners_.data(), 0}},
        first_instanced_(bvh.first_instanced_) {}

  /// Returns a node. Nodes of instances are computed in `room`.
  [[nodiscard]] RAYGATE_INLINE const Bvh::Node& node(std::uint32_t index, Bvh::Node& room) const {
    if (index >= first_instanced_) [[unlikely]] {
      bvh_->make_instance_node(index, room);
      return room;
    }
    return static_cast<const Bvh::Node*>(places_[Bvh::Child::kInner].begin)[index];
  }

  /// Returns the corners of a leaf's triangles. Coordinate k of corner v of triangle i is at index
  /// (3 v + k) leaf.count + i, which can be read for i up to 3; values for i >= leaf.count are
  /// meaningless. Corners of instances are computed in `room`.
  [[nodiscard]] RAYGATE_INLINE const float* corners_of(const Bvh::Child& leaf,
                                                       Bvh::LeafRoom& room) const {
    if (leaf.first >= first_instanced_) [[unlikely]] {
      const Bvh::Child copy = leaf;  // lets callers keep `leaf` in a register
      bvh_->make_instance_corners(copy, room);
      return room.corners;
    }
    return static_cast<const float*>(places_[Bvh::Child::kLeaf].begin) +
           9 * std::size_t{leaf.first};
  }

  /// Prefetches a child that will be visited soon; for kNone, the first leaf. Does not branch on
  /// the kind, to avoid mispredictions. (GCC 12 drops calls of functions that only prefetch.)
  RAYGATE_INLINE void prefetch(const Bvh::Child& child) const {
    if (child.first >= first_instanced_) [[unlikely]]
      return bvh_->prefetch_instance(child);
    const Place& place = places_[child.kind()];
    const char* const begin = static_cast<const char*>(place.begin) + place.bytes * child.first;
    for (std::ptrdiff_t line = 0; line < 4; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  static constexpr std::size_t kCornerBytes = 9 * sizeof(float);  // per primitive

  /// Address of the first child of one kind, and bytes per child.
  struct Place {
    const void* begin;
    std::size_t bytes;
  };

  const Bvh* bvh_;
  Place places_[Bvh::Child::kKinds];
  std::uint32_t first_instanced_;
};

}  // namespace raygate
