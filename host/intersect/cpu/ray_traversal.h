// Traversal state and steps of a single ray; many such rays are interleaved.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"
#include "host/bvh/packet_bounds.h"
#include "host/exact/exact.h"
#include "host/intersect/cpu/quad_test.h"
#include "host/intersect/intersector.h"

// Why no true hit is culled
//
// Distances are measured along the ray's longest axis: they are t times the t_scale p, which is the
// magnitude of the direction's largest component and in [1, 2). What packet_traversal.cpp says of t
// and 1 / I holds of p t and p / I: t I = x - O is (p t) (I / p), p / I is one quotient, rounded
// once; p / |I| >= 1 > 1/2, where the underflow of a product is paid for; |I| < 2^-100 has 2^100 <=
// p / |I|, so that p 2^100, exactly, does for inverse_near; and along the longest axis p t = |x -
// O| <= 2^127.

namespace raygate {

/// One ray on its way. Many take turns, so that what a step needs of one is kept in few cache
/// lines: the first for a node, the second for a leaf, the third for either, with the bottom of
/// `keys`.
struct alignas(64) RayTraversal {
  // Against boxes, by axis: see PacketBounds. A node has the planes to which the ray comes first,
  // and last, so many bytes from its beginning.
  float origin[3], inverse_near[3], inverse_far[3];
  std::uint32_t near_at[3], far_at[3];
  float cutoff;  ///< cutoff_beyond the nearest hit

  ShearedRay sheared;       ///< against triangles
  float low, high;          ///< bounds of the nearest hit's depth; without one, the limit's
  float enough;             ///< a hit whose depth is surely less is enough
  std::uint32_t primitive;  ///< of the nearest hit
  std::uint32_t skip_id, source_id;  ///< primitives
  std::uint32_t number;              ///< of the ray

  Bvh::Child at;  ///< what is visited next
  RayWork work;
  // What waits: children of nodes, the nearest last, as far as one node knows. A key is where the
  // ray enters a child's box, a little less at most, with the child's number in the last bits. At
  // the bottom is one that always matters: there the way ends.
  std::size_t depth;
  std::int32_t keys[1 + Bvh::kStackSize + Bvh::kWidth];
  std::uint32_t nodes[1 + Bvh::kStackSize + Bvh::kWidth];

  RayTraversal() {
    keys[0] = std::numeric_limits<std::int32_t>::min();
    nodes[0] = 0;
  }

  [[nodiscard]] double t_scale() const { return std::abs(sheared.way); }
  /// The nearest hit, or the limit, is at a t, or at a depth, within these bounds.
  RAYGATE_INLINE void end_at(const Interval& t) {
    end_at(float_below(t.low * t_scale()), float_above(t.high * t_scale()));
  }
  RAYGATE_INLINE void end_at(float lowest, float highest) {
    low = lowest;
    high = highest;
    cutoff = cutoff_beyond(highest);
  }
  [[nodiscard]] Interval t() const { return {low / t_scale(), high / t_scale()}; }
  /// Nothing that waits matters any more.
  void end() { depth = 1; }
  [[nodiscard]] bool has_ended() const { return depth == 0; }
};

/// Sends rays from the root on their ways, to no limit; bit i of the result where ray i is scaled,
/// without which its walk means nothing.
RAYGATE_INLINE LaneMask begin(const Ray* const (&rays)[kQuad],
                              RayTraversal* const (&walks)[kQuad]) {
  static_assert(sizeof(Ray) == 6 * sizeof(float) && offsetof(Ray, direction) == 3 * sizeof(float));
  constexpr std::int32_t kRow = sizeof(Bvh::Node::bounds[0][0]);
  static_assert(offsetof(Bvh::Node, bounds) == 0);
  FloatQuad first[kQuad], last[kQuad];  // the rays' first four words, and their last four
  for (int i = 0; i < kQuad; ++i) {
    first[i] = load<FloatQuad>(reinterpret_cast<const float*>(rays[i]));
    last[i] = load<FloatQuad>(reinterpret_cast<const float*>(rays[i] + 1) - kQuad);
  }
  transpose(first);
  transpose(last);
  const FloatQuad o[3] = {first[0], first[1], first[2]}, d[3] = {last[1], last[2], last[3]};
  // A RayTraversal's words, up to those of `at`.
  constexpr std::size_t kBoxWords = 16, kWords = 32;
  static_assert(offsetof(RayTraversal, sheared) == 4 * kBoxWords);
  static_assert(offsetof(RayTraversal, at) == 4 * kWords && kWords % kQuad == 0);
  FloatQuad words[kWords], sheared[sizeof(ShearedRay) / sizeof(float)];
  const auto word = [&](std::size_t offset) __attribute__((always_inline))->FloatQuad& {
    return words[offset / sizeof(float)];
  };
  shear(o, d, sheared);
  std::copy(std::begin(sheared), std::end(sheared), words + kBoxWords);
  const FloatQuad zero = {}, infinity = zero + std::numeric_limits<float>::infinity();
  word(offsetof(RayTraversal, cutoff)) = zero + std::numeric_limits<float>::max();
  word(offsetof(RayTraversal, low)) = word(offsetof(RayTraversal, high)) = infinity;
  word(offsetof(RayTraversal, enough)) = zero - 1.0f;
  const FloatQuad none = float_of(IntQuad{} + static_cast<std::int32_t>(NearestHit::kNone));
  word(offsetof(RayTraversal, primitive)) = none;
  word(offsetof(RayTraversal, skip_id)) = word(offsetof(RayTraversal, source_id)) = none;
  word(offsetof(RayTraversal, number)) = none;  // the caller's to say
  IntQuad largest = {};
  for (const FloatQuad& component : d) {
    largest = maximum(bits_in(absolute(component)), largest);  // a NaN's exceed any number's
  }
  const FloatQuad longest = float_of(largest);
  for (int k = 0; k < 3; ++k) {
    const FloatQuad size = absolute(d[k]);
    const IntQuad small = size < kSmallestComponent, back = d[k] < 0.0f;
    const FloatQuad one = {1.0f, 1.0f, 1.0f, 1.0f}, sign = back ? -one : one;
    const FloatQuad inverse = longest / (small ? sign * kSmallestComponent : d[k]);
    const IntQuad to_high = back & (3 * kRow), low_at = IntQuad{} + k * kRow;
    words[k] = o[k];
    words[3 + k] = inverse;
    words[6 + k] = kExitGrowth * (small ? sign * std::numeric_limits<float>::infinity() : inverse);
    words[9 + k] = float_of(low_at + to_high);
    words[12 + k] = float_of(low_at + 3 * kRow - to_high);
  }
  for (std::size_t word = 0; word < kWords; word += kQuad) {
    FloatQuad rows[kQuad] = {words[word], words[word + 1], words[word + 2], words[word + 3]};
    transpose(rows);
    for (int i = 0; i < kQuad; ++i) {
      std::memcpy(reinterpret_cast<char*>(walks[i]) + 4 * word, &rows[i], sizeof rows[i]);
    }
  }
  for (RayTraversal* const walk : walks) {
    walk->work = {};
    walk->at = {0, 0};
    walk->end();
  }
  return sign_mask((largest >= 0x3F800000) & (largest < 0x40000000));
}

/// Puts eight keys in order, the largest first: Batcher's bitonic network. All but `count` may be
/// known to be the smallest, and behind the others.
RAYGATE_INLINE void sort_falling(IntLanes& keys, std::size_t count = kLanes) {
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
  if (count <= kLanes / 2) return;
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
RAYGATE_INLINE void step_inside(const Bvh& tree, RayTraversal& walk) {
  constexpr std::int32_t kNumber = Bvh::kWidth - 1;
  constexpr IntLanes kNumbers = {0, 1, 2, 3, 4, 5, 6, 7};
  Bvh::Node room;
  const Bvh::Node& node = tree.node(walk.at.first, room);
  const char* const bounds = reinterpret_cast<const char*>(&node);
  using Floats = NativeFloats<kCode>;
  IntLanes keys;
  LaneMask mask = 0;
  for (std::size_t part = 0; part < Bvh::kWidth; part += sizeof(Floats) / sizeof(float)) {
    Floats enter = {}, leave = walk.cutoff - Floats{};
    for (int k = 0; k < 3; ++k) {
      Floats near, far;
      std::memcpy(&near, bounds + walk.near_at[k] + 4 * part, sizeof near);
      std::memcpy(&far, bounds + walk.far_at[k] + 4 * part, sizeof far);
      const Floats t_near = (near - walk.origin[k]) * walk.inverse_near[k];
      const Floats t_far = (far - walk.origin[k]) * walk.inverse_far[k];
      enter = t_near > enter ? t_near : enter;
      leave = t_far < leave ? t_far : leave;
    }
    mask |= sign_mask<kCode>(enter <= leave) << part;
    std::memcpy(reinterpret_cast<char*>(&keys) + 4 * part, &enter, sizeof enter);
  }
  keys = (keys & ~kNumber) | kNumbers;
  const auto count = static_cast<std::size_t>(std::popcount(mask));
#ifdef RAYGATE_AVX2
  if constexpr (kCode == Vectors::kAvx512) {
    avx512_compress(keys, mask);
    sort_falling(keys, count);
    std::memcpy(walk.keys + walk.depth, &keys, sizeof keys);
  } else
#endif
      if (count > 2) {
    const IntLanes met = lanes_of(mask);
    keys |= ~met;  // negative: they come last
    sort_falling(keys);
    std::memcpy(walk.keys + walk.depth, &keys, sizeof keys);
  } else {
    const std::int32_t first = keys[std::countr_zero(mask | 0x100) & kNumber];
    const std::int32_t second = keys[31 - std::countl_zero(mask | 1)];
    const std::int32_t to_smaller = std::int32_t{first > second} * (second - first);
    walk.keys[walk.depth] = second - to_smaller;
    walk.keys[walk.depth + 1] = first + to_smaller;
  }
  const IntLanes nodes = static_cast<std::int32_t>(walk.at.first) - IntLanes{};
  std::memcpy(walk.nodes + walk.depth, &nodes, sizeof nodes);
  walk.depth += count;
}

/// Goes on to what waits last and still matters.
RAYGATE_INLINE void go_on(const Bvh& tree, RayTraversal& walk) {
  constexpr std::int32_t kNumber = Bvh::kWidth - 1;
  // Floats from 0 on are in the order of their bits.
  const std::int32_t last_key = std::bit_cast<std::int32_t>(walk.cutoff) | kNumber;
  while (walk.keys[--walk.depth] > last_key) {
  }
  walk.at = tree.child_of(walk.nodes[walk.depth], walk.keys[walk.depth] & kNumber);
  tree.prefetch(walk.at);
}

}  // namespace raygate
