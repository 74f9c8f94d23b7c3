// A ray on its way through the tree, alone, and its steps: many such rays take turns.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "host/exact/exact.h"
#include "host/find/cpu/quad_test.h"
#include "host/find/finder.h"
#include "host/lanes.h"
#include "host/tree/beam.h"
#include "host/tree/bvh.h"

// Why no true hit is culled
//
// Distances are measured along the ray's longest axis: they are t times the pace p, which is the
// magnitude of the direction's largest component and in [1, 2). What packet_traversal.cpp says of t
// and 1 / I holds of p t and p / I: t I = x - O is (p t) (I / p), p / I is one quotient, rounded
// once; p / |I| >= 1 > 1/2, where the underflow of a product is paid for; |I| < 2^-100 has 2^100 <=
// p / |I|, so that p 2^100, exactly, does for inverse_near; and along the longest axis p t = |x -
// O| <= 2^127.

namespace raygate {

using UnsignedQuad = std::uint32_t __attribute__((vector_size(4 * kQuad), aligned(4 * kQuad)));

/// One ray on its way.
struct RayWalk {
  // Against boxes, by axis: see Beam. A node has the planes to which the ray comes first, and last,
  // so many bytes from its beginning.
  FloatQuad origin, inverse_near, inverse_far;
  UnsignedQuad near_at, far_at;
  float cutoff;  ///< cutoff_beyond the nearest hit

  std::uint32_t number;   ///< of the ray
  ShearedRay sheared;     ///< against triangles
  float low, high;        ///< bounds of the nearest hit's depth; without one, the limit's
  float enough;           ///< a hit whose depth is surely less is enough
  std::uint32_t slot;     ///< of the nearest hit
  std::uint32_t ignored;  ///< a slot
  RayWork work;
  double pace;

  Bvh::Child at;  ///< what is visited next
  // What waits: children of nodes, the nearest last, as far as one node knows. A key is where the
  // ray enters a child's box, a little less at most, with the child's number in the last bits.
  std::int32_t depth;
  std::int32_t keys[Bvh::kStackSize + Bvh::kWidth];
  std::uint32_t nodes[Bvh::kStackSize + Bvh::kWidth];

  /// Sets out along a ray that is scaled, towards a limit.
  RAYGATE_INLINE void set_out(const Ray& ray, std::uint32_t its_number, float limit);

  /// The nearest hit, or the limit, is at a t, or at a depth, within these bounds.
  RAYGATE_INLINE void end_at(const Interval& t) {
    end_at(float_below(t.low * pace), float_above(t.high * pace));
  }
  RAYGATE_INLINE void end_at(float lowest, float highest) {
    low = lowest;
    high = highest;
    cutoff = cutoff_beyond(highest);
  }
  [[nodiscard]] Interval t() const { return {low / pace, high / pace}; }
};

RAYGATE_INLINE void RayWalk::set_out(const Ray& ray, std::uint32_t its_number, float limit) {
  constexpr std::int32_t kRow = sizeof(Bvh::Node::bounds[0][0]);
  static_assert(offsetof(Bvh::Node, bounds) == 0);
  FloatQuad d, size;
  load_ray(ray, origin, d);
  magnitude(d, size);
  const int farthest = size[2] >= size[0] && size[2] >= size[1] ? 2 : (size[1] >= size[0] ? 1 : 0);
  const float longest = std::max(std::max(size[0], size[1]), size[2]);
  sheared = ShearedRay(origin, d, farthest);
  const IntQuad small = size < kSmallestComponent, back = d < 0.0f;
  const FloatQuad one = {1.0f, 1.0f, 1.0f, 1.0f}, sign = back ? -one : one;
  inverse_near = longest / (small ? sign * kSmallestComponent : d);
  inverse_far =
      kExitGrowth * (small ? sign * std::numeric_limits<float>::infinity() : inverse_near);
  constexpr IntQuad kLows = {0, kRow, 2 * kRow, 0}, kHighs = kLows + 3 * kRow;
  near_at = reinterpret_cast<UnsignedQuad>(back ? kHighs : kLows);
  far_at = reinterpret_cast<UnsignedQuad>(back ? kLows : kHighs);
  number = its_number;
  pace = longest;
  slot = ignored = NearestHit::kNone;
  enough = -1.0f;
  work = {};
  depth = 0;
  at = {0, 0};
  end_at(Interval{limit, limit});
}

/// Puts eight keys in order, the largest first: Batcher's bitonic network.
RAYGATE_INLINE void sort_falling(IntLanes& keys) {
  IntLanes other, larger, smaller;
  const auto compare = [&]() __attribute__((always_inline)) {
    larger = keys > other ? keys : other;
    smaller = keys > other ? other : keys;
  };
  const auto of_pairs = [&]() __attribute__((always_inline)) {
    other = __builtin_shufflevector(keys, keys, 1, 0, 3, 2, 5, 4, 7, 6);
    compare();
    keys = __builtin_shufflevector(larger, smaller, 0, 9, 2, 11, 4, 13, 6, 15);
  };
  of_pairs();
  other = __builtin_shufflevector(keys, keys, 3, 2, 1, 0, 7, 6, 5, 4);
  compare();
  keys = __builtin_shufflevector(larger, smaller, 0, 1, 10, 11, 4, 5, 14, 15);
  of_pairs();
  other = __builtin_shufflevector(keys, keys, 7, 6, 5, 4, 3, 2, 1, 0);
  compare();
  keys = __builtin_shufflevector(larger, smaller, 0, 1, 2, 3, 12, 13, 14, 15);
  other = __builtin_shufflevector(keys, keys, 2, 3, 0, 1, 6, 7, 4, 5);
  compare();
  keys = __builtin_shufflevector(larger, smaller, 0, 1, 10, 11, 4, 5, 14, 15);
  of_pairs();
}

/// Puts the children of the inner node where the ray is onto its stack, those whose boxes it meets.
/// Without a branch but for three or more, as which these are nobody can foretell.
template <Vectors kCode>
RAYGATE_INLINE void step_inside(const Bvh& tree, RayWalk& walk) {
  constexpr std::int32_t kNumber = Bvh::kWidth - 1;
  constexpr IntLanes kNumbers = {0, 1, 2, 3, 4, 5, 6, 7};
  const Bvh::Node& node = tree.nodes()[walk.at.first];
  const char* const bounds = reinterpret_cast<const char*>(&node);
  FloatLanes enter = {}, leave = walk.cutoff - FloatLanes{};
  for (int k = 0; k < 3; ++k) {
    FloatLanes near, far;
    std::memcpy(&near, bounds + walk.near_at[k], sizeof near);
    std::memcpy(&far, bounds + walk.far_at[k], sizeof far);
    const FloatLanes t_near = (near - walk.origin[k]) * walk.inverse_near[k];
    const FloatLanes t_far = (far - walk.origin[k]) * walk.inverse_far[k];
    enter = t_near > enter ? t_near : enter;
    leave = t_far < leave ? t_far : leave;
  }
  const IntLanes met = enter <= leave;
  const LaneMask mask = sign_mask<kCode>(met);
  const int count = std::popcount(mask);
  IntLanes keys = (reinterpret_cast<IntLanes>(enter) & ~kNumber) | kNumbers;
  if (count > 2) {
    keys = met ? keys : IntLanes{} - 1;
    sort_falling(keys);
    std::memcpy(walk.keys + walk.depth, &keys, sizeof keys);
  } else {
    const std::int32_t first = keys[std::countr_zero(mask | 0x100) & kNumber];
    const std::int32_t second = keys[31 - std::countl_zero(mask | 1)];
    walk.keys[walk.depth] = std::max(first, second);
    walk.keys[walk.depth + 1] = std::min(first, second);
  }
  const IntLanes nodes = static_cast<std::int32_t>(walk.at.first) - IntLanes{};
  std::memcpy(walk.nodes + walk.depth, &nodes, sizeof nodes);
  walk.depth += count;
}

/// Goes on to what waits last and still matters; false where nothing does.
RAYGATE_INLINE bool go_on(const Bvh& tree, RayWalk& walk) {
  constexpr std::int32_t kNumber = Bvh::kWidth - 1;
  const auto cutoff = std::bit_cast<std::int32_t>(walk.cutoff);  // floats from 0 on: in order
  while (walk.depth > 0) {
    const std::int32_t key = walk.keys[--walk.depth];
    if ((key & ~kNumber) > cutoff) continue;
    walk.at = tree.nodes()[walk.nodes[walk.depth]].child[key & kNumber];
    tree.prefetch(walk.at);
    return true;
  }
  return false;
}

}  // namespace raygate
