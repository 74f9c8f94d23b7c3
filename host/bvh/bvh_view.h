// BvhView: what a walk reads of a tree.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/bvh/bvh.h"

namespace raygate {

/// The nodes and leaves of a Bvh, which must outlive it and not move. To be held by value: of a
/// reference, compilers read the parts anew after each store.
class BvhView {
 public:
  explicit BvhView(const Bvh& bvh)
      : bvh_(&bvh),
        places_{{bvh.nodes_.data(), sizeof(Bvh::Node)},
                {bvh.corners_.data(), kCornerBytes},
                {bvh.corners_.data(), 0}},
        first_instanced_(bvh.first_instanced_) {}

  /// A node, which may be made in `room`.
  [[nodiscard]] RAYGATE_INLINE const Bvh::Node& node(std::uint32_t index, Bvh::Node& room) const {
    if (index >= first_instanced_) [[unlikely]] {
      bvh_->make_instance_node(index, room);
      return room;
    }
    return static_cast<const Bvh::Node*>(places_[Bvh::Child::kInner].begin)[index];
  }

  /// The corners of a leaf's triangles, one coordinate of all of them after the other: coordinate k
  /// of corner v of triangle i is [(3 v + k) count + i]. What comes after the last one may be read,
  /// and means nothing, as far as for four triangles. They may be made in `room`.
  [[nodiscard]] RAYGATE_INLINE const float* corners_of(const Bvh::Child& leaf,
                                                       Bvh::LeafRoom& room) const {
    if (leaf.first >= first_instanced_) [[unlikely]] {
      const Bvh::Child copy = leaf;  // so that callers may keep theirs in a register
      bvh_->make_instance_corners(copy, room);
      return room.corners;
    }
    return static_cast<const float*>(places_[Bvh::Child::kLeaf].begin) +
           9 * std::size_t{leaf.first};
  }

  /// Says that a child will soon be visited; kNone stands for the first leaf, as good as any other.
  /// Without a branch, which would be a guess about its kind. (Always inlined: GCC 12 takes a
  /// function that does nothing but prefetch for one without effect, and leaves its calls out.)
  RAYGATE_INLINE void prefetch(const Bvh::Child& child) const {
    if (child.first >= first_instanced_) [[unlikely]]
      return bvh_->prefetch_instance(child);
    const Place& place = places_[child.kind()];
    const char* const begin = static_cast<const char*>(place.begin) + place.bytes * child.first;
    for (std::ptrdiff_t line = 0; line < 4; ++line) __builtin_prefetch(begin + 64 * line);
  }

 private:
  static constexpr std::size_t kCornerBytes = 9 * sizeof(float);  // of a primitive

  /// Where children of a kind are stored, and how many bytes each takes.
  struct Place {
    const void* begin;
    std::size_t bytes;
  };

  const Bvh* bvh_;
  Place places_[Bvh::Child::kKinds];
  std::uint32_t first_instanced_;
};

}  // namespace raygate
