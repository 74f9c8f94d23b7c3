// BVH traversal, leaf by leaf and nearest first, for any visitor.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "host/base/lanes.h"
#include "host/bvh/bvh_view.h"

namespace raygate {

/// A node or leaf to visit, with a lower bound of the distance at which the first ray enters its
/// box, and the rays that may enter it.
template <class Rays>
struct StackEntry {
  Bvh::Child child;
  float entry;
  [[no_unique_address]] Rays rays;
};

/// The nodes and leaves to visit. The nearest child of a node is on top of its siblings.
template <class Rays>
struct TraversalStack {
  int depth;
  StackEntry<Rays> waiting[Bvh::kStackSize];

  explicit TraversalStack(const Rays& rays) : depth(1) { waiting[0] = {{0, 0}, 0.0f, rays}; }
};

/// Ray set of a traversal with a single ray.
struct SingleRay {};

/// Advances to the next leaf; returns false if there is none. The visitor may change its cutoff
/// between calls. It provides
///   * should_visit(entry, rays): returns whether a child is still relevant to any of `rays`; may
///     remove rays;
///   * intersect_boxes(node, rays, entry): returns a mask of the children that the rays meet, and
///     sets their entry distances, 0 or more;
///   * rays_of_child(i): returns the rays that meet child i, after intersect_boxes.
template <class Visitor, class Rays>
RAYGATE_INLINE bool next_leaf(const BvhView& tree, Visitor& visitor, TraversalStack<Rays>& stack,
                              StackEntry<Rays>& leaf) {
  using Key = std::int32_t;  // entry distance, with the child's index in the last bits
  constexpr Key kNumber = Bvh::kWidth - 1;
  constexpr IntLanes kNumbers = {0, 1, 2, 3, 4, 5, 6, 7};
  while (stack.depth > 0) {
    leaf = stack.waiting[--stack.depth];
    while (visitor.should_visit(leaf.entry, leaf.rays)) {
      if (leaf.child.count != 0) return true;
      Bvh::Node room;
      const Bvh::Node& node = tree.node(leaf.child.first, room);
      FloatLanes entry;
      LaneMask met = visitor.intersect_boxes(node, leaf.rays, entry);
      if (met == 0) break;
      IntLanes keys = bits_in(entry);
      keys = (keys & ~kNumber) | kNumbers;
      const auto take = [&]() __attribute__((always_inline)) {
        const Key key = keys[std::countr_zero(met)];
        met &= met - 1;
        return key;
      };
      const auto child_at = [&](Key key, StackEntry<Rays> & child) __attribute__((always_inline)) {
        const int i = key & kNumber;
        child = {node.child[i], std::bit_cast<float>(key & ~kNumber), visitor.rays_of_child(i)};
        tree.prefetch(child.child);
      };
      const auto push = [&](Key key) __attribute__((always_inline)) {
        StackEntry<Rays>& child = stack.waiting[stack.depth++];
        child_at(key, child);
      };
      Key nearest = take();
      if (met != 0) {
        const Key next = take();
        if (met == 0) {
          push(std::max(nearest, next));
          nearest = std::min(nearest, next);
        } else {
          Key sorted[Bvh::kWidth] = {std::max(nearest, next), std::min(nearest, next)};
          int count = 2;
          while (met != 0) {  // NOLINT(bugprone-infinite-loop): take() takes one of them
            const Key key = take();
            int place = count++;
            for (; place > 0 && sorted[place - 1] < key; --place) sorted[place] = sorted[place - 1];
            sorted[place] = key;
          }
          nearest = sorted[--count];
          for (int i = 0; i < count; ++i) push(sorted[i]);
        }
      }
      child_at(nearest, leaf);
    }
  }
  return false;
}

}  // namespace raygate
