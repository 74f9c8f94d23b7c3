// BvhView: the arrays of a BVH, for traversal.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/bvh/bvh.h"

namespace raygate {

/// The nodes and leaves of a Bvh, which must outlive the view and not move. Hold it by value:
/// through a reference, compilers load the pointers again after each store.
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

  /// Returns the corners of a leaf's triangles: coordinate k of corner v of triangle i is at [(3 v
  /// + k) count + i]. Further floats, up to four triangles, can be read but are undefined. Corners
  /// of instances are computed in `room`.
  [[nodiscard]] RAYGATE_INLINE const float* corners_of(const Bvh::Child& leaf,
                                                       Bvh::LeafRoom& room) const {
    if (leaf.first >= first_instanced_) [[unlikely]] {
      const Bvh::Child copy = leaf;  // lets callers keep theirs in a register
      bvh_->make_instance_corners(copy, room);
      return room.corners;
    }
    return static_cast<const float*>(places_[Bvh::Child::kLeaf].begin) +
           9 * std::size_t{leaf.first};
  }

  /// Prefetches a child that will be visited soon; for kNone, the first leaf. There is no branch on
  /// the kind, which would be mispredicted. (Always inlined: GCC 12 drops calls of a function that
  /// only prefetches.)
  RAYGATE_INLINE void prefetch(const Bvh::Child& child) const {
    if (child.first >= first_instanced_) [[unlikely]]
      return bvh_->prefetch_instance(child);
    const Place& place = places_[child.kind()];
    const char* const begin = static_cast<const char*>(place.begin) + place.bytes * child.first;
    for (std::ptrdiff_t line = 0; line < 4; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  static constexpr std::size_t kCornerBytes = 9 * sizeof(float);  // per primitive

  /// Address of the children of one kind, and bytes per child.
  struct Place {
    const void* begin;
    std::size_t bytes;
  };

  const Bvh* bvh_;
  Place places_[Bvh::Child::kKinds];
  std::uint32_t first_instanced_;
};

}  // namespace raygate
