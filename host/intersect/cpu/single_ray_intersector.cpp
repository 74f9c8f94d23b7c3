#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "host/base/lanes.h"
#include "host/bvh/traversal.h"
#include "host/exact/exact.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/cpu/quad_test.h"

// Why no true hit is culled
//
// Depths are distances along the ray's longest axis: p t, where p in [1, 2) is the magnitude of the
// direction's largest component (RayTraversal::t_scale). The proof in packet_traversal.cpp also
// holds with p t in place of t and p / I in place of 1 / I, on each axis with origin O and
// direction I, for a hit at x:
//  - x - O = t I = (p t) (I / p), and p / I is one quotient, rounded once like 1 / I.
//  - p / |I| >= 1 > 1/2, so the widening of boxes covers an underflow of a product.
//  - For |I| < 2^-100, inverse_near is p 2^100, which is exact and at most p / |I|.
//  - Along the longest axis, p t = |x - O| <= 2^127.
// For a ray that is rounded to binary32, see spread().

namespace raygate {
namespace {

/// State of one ray. Many rays are interleaved, so each step uses few cache lines: at a node the
/// first line, at a leaf the second. Both kinds of steps also use the third line, which holds the
/// bottom of `keys`, and the line with the bottom of `children`.
struct alignas(64) RayTraversal {
  // Box tests, by axis. Inverses are those of PacketBounds, negated: then the instruction that
  // subtracts in (origin - near) * minus_inverse_near also loads the plane. near_at and far_at are
  // byte offsets in a node of the planes that the ray meets first and last.
  float origin[3], minus_inverse_near[3], minus_inverse_far[3];
  std::uint32_t near_at[3], far_at[3];
  float cutoff;  ///< cutoff_beyond() of the nearest hit

  ShearedRay sheared;                ///< for triangle tests
  float low, high;                   ///< bounds of the depth of the nearest hit or the limit
  float enough;                      ///< a hit whose depth is surely less ends the ray
  std::uint32_t primitive;           ///< primitive of the nearest hit
  std::uint32_t skip_id, source_id;  ///< primitives, see RayQuery
  std::uint32_t number;              ///< index of the ray

  RayWork work;
  // Stack of children to visit. Of one node's children, the nearest is on top. The top entry is the
  // child being visited. A key is a lower bound of the entry distance, with the child's number in
  // its last bits. The bottom is a sentinel that is never skipped and ends the traversal.
  std::size_t depth;
  std::int32_t keys[1 + Bvh::kStackSize + Bvh::kWidth];
  Bvh::Child children[1 + Bvh::kStackSize + Bvh::kWidth];

  // Set only if corners or the ray are rounded:
  double exact_scale;    ///< largest magnitude of the exact direction's components
  float exit_origin[3];  ///< see spread()
  RoundedParts rounding;

  RayTraversal() {
    keys[0] = std::numeric_limits<std::int32_t>::min();
    children[0] = {0, Bvh::kMaxLeafSize + 1};
  }

  /// Returns the node or leaf that is visited.
  [[nodiscard]] const Bvh::Child& at() const { return children[depth]; }
  template <bool kIsRounded>
  [[nodiscard]] double t_scale() const {
    return kIsRounded ? exact_scale : std::abs(sheared.way);
  }
  /// Set `low`, `high` and `cutoff` to bounds of the nearest hit or limit, given as t or as depth.
  template <bool kIsRounded>
  RAYGATE_INLINE void end_at(const Interval& t) {
    const double scale = t_scale<kIsRounded>();
    end_at(float_below(t.low * scale), float_above(t.high * scale));
  }
  RAYGATE_INLINE void end_at(float lowest, float highest) {
    low = lowest;
    high = highest;
    cutoff = cutoff_beyond(highest);
  }
  template <bool kIsRounded>
  [[nodiscard]] Interval t() const {
    return {low / t_scale<kIsRounded>(), high / t_scale<kIsRounded>()};
  }
  void end() { depth = 1; }
};

/// Starts rays at the root, without limits. Returns a mask: bit i is set if ray i is scaled;
/// otherwise the ray's traversal is undefined.
template <class Floats>
RAYGATE_INLINE LaneMask begin(const Ray* const (&rays)[kLanesOf<Floats>],
                              RayTraversal* const (&walks)[kLanesOf<Floats>]) {
  using Ints = IntOf<Floats>;
  static_assert(sizeof(Ray) == 6 * sizeof(float) && offsetof(Ray, direction) == 3 * sizeof(float));
  constexpr std::int32_t kRow = sizeof(Bvh::Node::bounds[0][0]);
  static_assert(offsetof(Bvh::Node, bounds) == 0);
  Floats first[kQuad], last[kQuad];  // the rays' first four words, and their last four
  for (int i = 0; i < kQuad; ++i) {
    const auto words_of = [&](int half) {
      return reinterpret_cast<const float*>(rays[4 * half + i]);
    };
    first[i] =
        joined<Floats>([&](int half) RAYGATE_BODY { return load<FloatQuad>(words_of(half)); });
    last[i] =
        joined<Floats>([&](int half) RAYGATE_BODY { return load<FloatQuad>(words_of(half) + 2); });
  }
  transpose(first);
  transpose(last);
  const Floats o[3] = {first[0], first[1], first[2]}, d[3] = {last[1], last[2], last[3]};
  // The words of a RayTraversal up to `work`.
  constexpr std::size_t kBoxWords = 16, kWords = 32;
  static_assert(offsetof(RayTraversal, sheared) == 4 * kBoxWords);
  static_assert(offsetof(RayTraversal, work) == 4 * kWords && kWords % kQuad == 0);
  Floats words[kWords], sheared[sizeof(ShearedRay) / sizeof(float)];
  const auto word = [&](std::size_t offset) __attribute__((always_inline))->Floats& {
    return words[offset / sizeof(float)];
  };
  shear(o, d, sheared);
  std::copy(std::begin(sheared), std::end(sheared), words + kBoxWords);
  const Floats zero = {}, infinity = zero + std::numeric_limits<float>::infinity();
  word(offsetof(RayTraversal, cutoff)) = zero + std::numeric_limits<float>::max();
  word(offsetof(RayTraversal, low)) = word(offsetof(RayTraversal, high)) = infinity;
  word(offsetof(RayTraversal, enough)) = zero - 1.0f;
  const Floats none = float_of(Ints{} + static_cast<std::int32_t>(NearestHit::kNone));
  word(offsetof(RayTraversal, primitive)) = none;
  word(offsetof(RayTraversal, skip_id)) = word(offsetof(RayTraversal, source_id)) = none;
  word(offsetof(RayTraversal, number)) = none;  // set by the caller
  Ints largest = {};
  for (const Floats& component : d) {
    // The bits of a NaN exceed those of any number.
    largest = maximum(bits_in(absolute(component)), largest);
  }
  const Floats longest = float_of(largest);
  for (int k = 0; k < 3; ++k) {
    const Floats size = absolute(d[k]);
    const Ints small = size < kSmallestComponent, back = d[k] < 0.0f;
    const Floats one = Floats{} + 1.0f, sign = back ? -one : one;
    const Floats minus_inverse = -(longest / (small ? sign * kSmallestComponent : d[k]));
    const Floats minus_infinity = sign * -std::numeric_limits<float>::infinity();
    const Ints to_high = back & (3 * kRow), low_at = Ints{} + k * kRow;
    words[k] = o[k];
    words[3 + k] = minus_inverse;
    words[6 + k] = kExitGrowth * (small ? minus_infinity : minus_inverse);
    words[9 + k] = float_of(low_at + to_high);
    words[12 + k] = float_of(low_at + 3 * kRow - to_high);
  }
  for (std::size_t word = 0; word < kWords; word += kQuad) {
    Floats rows[kQuad] = {words[word], words[word + 1], words[word + 2], words[word + 3]};
    transpose(rows);
    const auto* const quads = reinterpret_cast<const FloatQuad*>(rows);
    constexpr int kEach = kLanesOf<Floats> / kQuad;  // quads in a row
    for (int i = 0; i < kLanesOf<Floats>; ++i) {
      store(reinterpret_cast<char*>(walks[i]) + 4 * word, quads[kEach * (i % kQuad) + i / kQuad]);
    }
  }
  for (RayTraversal* const walk : walks) {
    walk->work = {};
    walk->end();
    walk->children[walk->depth] = {0, 0};
  }
  return sign_mask((largest >= 0x3F800000) & (largest < 0x40000000));
}

/// Table by mask of lanes: the indices of the mask's lanes in order, followed by negative values.
constexpr auto kNumbersOf = [] {
  std::array<std::array<std::int32_t, kLanes>, 1 << kLanes> numbers{};
  for (std::size_t mask = 0; mask < numbers.size(); ++mask) {
    std::size_t count = 0;
    numbers[mask].fill(std::numeric_limits<std::int32_t>::min());
    for (std::int32_t i = 0; i < kLanes; ++i) {
      if ((mask >> i & 1) != 0) numbers[mask][count++] = i;
    }
  }
  return numbers;
}();

/// Sorts eight keys in descending order (Batcher's bitonic network); only `count` are >= 0.
RAYGATE_INLINE void sort_falling(IntLanes& keys, std::size_t count) {
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
  if (count <= 2) return;
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

/// The children of a node, and a mask of those whose boxes a ray meets.
struct MetChildren {
  IntLanes keys;  ///< entry distances of the met children, as bits of non-negative floats
  const Bvh::Child* children;
  LaneMask mask;
};

/// Tests the ray against the boxes of its current node; `room` is for a node of an instance.
template <Vectors kCode, bool kIsRounded>
RAYGATE_INLINE void meet_children(const BvhView& tree, const RayTraversal& walk, Bvh::Node& room,
                                  MetChildren& met) {
  const Bvh::Node& node = tree.node(walk.at().first, room);
  met.children = node.child;
  const char* const bounds = reinterpret_cast<const char*>(&node);
  using Floats = NativeFloats<kCode>;
  LaneMask mask = 0;
  for (std::size_t part = 0; part < Bvh::kWidth; part += sizeof(Floats) / sizeof(float)) {
    Floats enter = {}, leave = walk.cutoff - Floats{};
    for (int k = 0; k < 3; ++k) {
      Floats near, far;
      std::memcpy(&near, bounds + walk.near_at[k] + 4 * part, sizeof near);
      std::memcpy(&far, bounds + walk.far_at[k] + 4 * part, sizeof far);
      const Floats t_near = (walk.origin[k] - near) * walk.minus_inverse_near[k];
      const float from = kIsRounded ? walk.exit_origin[k] : walk.origin[k];
      const Floats t_far = (from - far) * walk.minus_inverse_far[k];
      enter = t_near > enter ? t_near : enter;
      leave = t_far < leave ? t_far : leave;
    }
    mask |= sign_mask<kCode>(enter <= leave) << part;
    std::memcpy(reinterpret_cast<char*>(&met.keys) + 4 * part, &enter, sizeof enter);
  }
  met.mask = mask;
}

/// Pushes the children that the ray meets. Branchless for up to two, to avoid mispredictions.
template <Vectors kCode>
RAYGATE_INLINE void push_children(RayTraversal& walk, const MetChildren& met) {
  constexpr std::int32_t kNumber = Bvh::kWidth - 1;
  constexpr IntLanes kNumbers = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto count = static_cast<std::size_t>(std::popcount(met.mask));
  const auto& numbers = kNumbersOf[met.mask];
  std::int32_t* const to_keys = walk.keys + walk.depth;
  Bvh::Child* const to_children = walk.children + walk.depth;
  walk.depth += count;
  const auto push = [&](int first, int last) __attribute__((always_inline)) {
    for (int i = first; i < last; ++i) to_children[i] = met.children[to_keys[i] & kNumber];
  };
  // Handles up to two children one by one, because no register holds all eight keys.
  if (kCode == Vectors::kBaseline && count <= 2) {
    const auto key = [&](int i) __attribute__((always_inline)) {
      return (met.keys[numbers[i] & kNumber] & ~kNumber) | numbers[i];
    };
    const std::int32_t one = key(0), other = key(1);
    const std::int32_t swap = (one ^ other) & -std::int32_t{one < other};
    to_keys[0] = one ^ swap;
    to_keys[1] = other ^ swap;
    push(0, 2);
    return;
  }
  // Puts the keys of met children first, or makes all other keys negative.
  IntLanes keys = met.keys & ~kNumber;
#ifdef RAYGATE_AVX2
  if constexpr (kCode != Vectors::kBaseline) {
    const auto lanes = load<IntLanes>(numbers.data());
    avx2_permute(keys, lanes);
    keys |= lanes;
  } else
#endif
  {
    keys |= kNumbers | ~lanes_of(met.mask);
  }
  sort_falling(keys, kCode == Vectors::kBaseline ? kLanes : count);
  std::memcpy(to_keys, &keys, sizeof keys);
  push(0, 2);
  if (count <= 2) return;
  push(2, 4);
  if (count <= 4) return;
  push(4, Bvh::kWidth);
}

/// Pops the next subtree that is not beyond the cutoff.
RAYGATE_INLINE void go_on(const BvhView& tree, RayTraversal& walk) {
  // The bits of non-negative floats have the order of the floats.
  const std::int32_t last_key = std::bit_cast<std::int32_t>(walk.cutoff) | (Bvh::kWidth - 1);
  do {
    --walk.depth;
  } while (walk.keys[walk.depth] > last_key);
  tree.prefetch(walk.at());
}

/// Traverses the BVH with several rays, interleaved. Tests a leaf's triangles directly from their
/// corners (quad_test.h). Exact arithmetic resolves doubts of float32 and orders hits, so results
/// equal those of other intersectors. `kIsRounded`: whether corners or rays are rounded.
template <bool kIsRounded>
class SingleRayIntersector {
 public:
  SingleRayIntersector(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters)
      : bvh_(bvh),
        counters_(counters),
        rays_(rays),
        query_(query),
        hits_(hits),
        points_(bvh, rays, false, hits) {}

  void trace() {
    walk_all();
    points_.write();
    counters_.hit.plane_tests += points_.written();
  }

 private:
  // Number of interleaved rays: enough to hide memory latency, few enough for a 32 KB cache that
  // another thread of the core may share.
  static constexpr int kAtOnce = 32;

  /// Completes the tests of a leaf after find_sides(). Returns false if the ray can end.
  RAYGATE_INLINE bool judge(RayTraversal& walk, const Bvh::Child& leaf, const QuadSides& sides,
                            LaneMask open) {
    QuadVerdict verdict;
    judge_sides<kIsRounded>(walk.sheared, sides, open, verdict);
    open = verdict.hit | verdict.level | verdict.doubt;
    HitCounters& counters = counters_.hit;
    counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
    walk.work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
    for (const int i : SetBits(open)) {
      const std::uint32_t primitive = leaf.first + static_cast<std::uint32_t>(i);
      const float low = verdict.low[i], high = verdict.high[i];
      if (primitive == walk.skip_id || primitive == walk.source_id) continue;
      if (low > walk.high) continue;
      if ((verdict.level >> i & 1) != 0) {
        if (!is_ahead(exact_ray(walk.number), bvh_.corners_of(primitive))) continue;
        ++counters.hits;
      }
      if ((verdict.doubt >> i & 1) != 0) {
        if (!resolve(walk, primitive, false)) continue;
      } else if (high < walk.low) {
        walk.primitive = primitive;
        walk.end_at(std::max(low, 0.0f), high);
      } else if (!resolve(walk, primitive, true)) {
        continue;
      }
      if (walk.high < walk.enough) {
        ++counters_.ended_early;
        return false;
      }
    }
    return true;
  }

  /// Decides exactly whether a primitive is the ray's nearest hit, and returns whether it is.
  /// `sure`: the primitive is hit; only the order of hits must be decided.
  bool resolve(RayTraversal& walk, std::uint32_t primitive, bool sure) {
    const ExactRay ray = exact_ray(walk.number);
    NearestHit best;
    if (walk.primitive != NearestHit::kNone) {
      best.primitive = walk.primitive;
      best.t = walk.template t<kIsRounded>();
      counters_.hit.depth_doubts += sure;
    }
    NearestHit hit = {.primitive = primitive};
    if (sure) hit.t = hit_distance(ray, bvh_.corners_of(primitive));
    if (!take_if_nearest(bvh_, ray, query_.t_max_of(walk.number), hit, sure, best, counters_)) {
      return false;
    }
    walk.primitive = primitive;
    walk.template end_at<kIsRounded>(best.t);
    return true;
  }

  [[nodiscard]] ExactRay exact_ray(std::uint32_t number) const {
    return query_.exact_rays.empty() ? ExactRay(rays_[number]) : query_.exact_rays[number];
  }

  /// Sets the fields that depend on the rounding of a ray and of the vertices to binary32.
  void set_rounding(RayTraversal& walk) const {
    const ExactRay ray = exact_ray(walk.number);
    walk.exact_scale = std::abs(ray.direction[walk.sheared.axes[2]]);
    walk.rounding = RoundedParts(!bvh_.is_binary32(), ray);
    spread(ray, walk.origin, walk.exit_origin, walk.minus_inverse_far);
  }

  /// Starts the next rays, one in each walk. Returns a mask of the walks with a ray to trace.
  template <class Floats>
  RAYGATE_INLINE LaneMask begin(RayTraversal* const (&walks)[kLanesOf<Floats>]) {
    constexpr std::size_t kMost = kLanesOf<Floats>;
    const auto first = static_cast<std::uint32_t>(next_);
    const std::size_t count = std::min(kMost, rays_.size() - next_);
    const Ray* rays[kMost];
    for (std::size_t i = 0; i < kMost; ++i) rays[i] = &rays_[next_ + std::min(i, count - 1)];
    next_ += count;
    const LaneMask all = (1u << count) - 1, scaled = raygate::begin<Floats>(rays, walks) & all;
    for (const int i : SetBits(all & ~scaled)) {
      if (is_usable(rays[i]->direction)) throw_unscaled(*rays[i]);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      RayTraversal& walk = *walks[i];
      const std::uint32_t number = walk.number = first + i;
      if constexpr (kIsRounded) set_rounding(walk);
      if (!query_.t_max.empty()) {
        walk.template end_at<kIsRounded>(Interval{query_.t_max[number], query_.t_max[number]});
      }
      if (!query_.skip_ids.empty()) walk.skip_id = query_.skip_ids[number];
      if (!query_.source_ids.empty()) walk.source_id = query_.source_ids[number];
      if (!query_.any_hit_before.empty()) {
        walk.enough =
            float_below(query_.any_hit_before[number] * walk.template t_scale<kIsRounded>());
      }
    }
    return scaled;
  }

  RAYGATE_INLINE void finish(const RayTraversal& walk) {
    HitCounters& counters = counters_.hit;
    counters.tests += walk.work.tests;
    counters.edge_doubts += walk.work.doubts;
    if (!query_.work.empty()) query_.work[walk.number] = walk.work;
    hits_[walk.number].primitive = walk.primitive;
    if (walk.primitive == NearestHit::kNone) return;
    hits_[walk.number].t = walk.template t<kIsRounded>();
    if (query_.with_points) points_.add(walk.number, walk.primitive);
  }

  /// Traverses the BVH with all rays, nearest children first. kAtOnce rays are interleaved to hide
  /// memory latency. Choices that depend on a ray avoid branches, which are often mispredicted.
  void walk_all() {
    const auto walks = std::make_unique<RayTraversal[]>(kAtOnce);
    in_vectors([&](auto code) RAYGATE_BODY {
      // Rays by state: at inner nodes, at leaves, or without work.
      RayTraversal *inside[2 * kAtOnce], *leaves[kAtOnce], *idle[kAtOnce];
      // The children that rays at inner nodes meet.
      MetChildren met[kAtOnce];
      Bvh::Node rooms[kAtOnce];
      // Rays at leaves that do not surely miss all triangles.
      struct {
        RayTraversal* walk;
        LaneMask open;
        QuadSides sides;
      } near[kAtOnce];
      constexpr std::size_t kStarted = kLanesOf<NativeFloats<code()>>;
      std::size_t inside_count = 0, leaf_count = 0, idle_count = kAtOnce;
      const BvhView tree(bvh_);
      for (std::size_t i = 0; i < kAtOnce; ++i) idle[i] = &walks[i];
      for (;;) {
        while (idle_count >= kStarted && next_ < rays_.size()) {
          idle_count -= kStarted;
          RayTraversal* walks_to_start[kStarted];
          std::copy_n(idle + idle_count, kStarted, walks_to_start);
          const LaneMask started = begin<NativeFloats<code()>>(walks_to_start);
          for (std::size_t i = 0; i < kStarted; ++i) {
            const std::size_t on_its_way = started >> i & 1;
            inside[inside_count] = idle[idle_count] = walks_to_start[i];
            inside_count += on_its_way;
            idle_count += on_its_way ^ 1;
          }
        }
        if (inside_count + leaf_count == 0) return;
        // Two short loops let the processor overlap more rays.
        for (std::size_t i = 0; i < inside_count; ++i) {
          meet_children<code(), kIsRounded>(tree, *inside[i], rooms[i], met[i]);
        }
        for (std::size_t i = 0; i < inside_count; ++i) push_children<code()>(*inside[i], met[i]);
        auto* near_end = near;
        for (std::size_t i = 0; i < leaf_count; ++i) {
          RayTraversal& walk = *leaves[i];
          const Bvh::Child leaf = walk.at();
          walk.work.tests += leaf.count;
          Bvh::LeafRoom room;
          near_end->walk = inside[inside_count + i] = &walk;
          near_end->open = find_sides<kIsRounded>(walk.sheared, tree.corners_of(leaf, room),
                                                  leaf.count, near_end->sides, walk.rounding);
          near_end += near_end->open != 0 ? 1 : 0;
        }
        for (const auto* at = near; at != near_end; ++at) {
          if (!judge(*at->walk, at->walk->at(), at->sides, at->open)) at->walk->end();
        }
        const std::size_t count = inside_count + leaf_count, were_idle = idle_count;
        RayTraversal** ends[Bvh::Child::kKinds] = {inside, leaves, idle + idle_count};
        for (std::size_t i = 0; i < count; ++i) {
          RayTraversal& walk = *inside[i];
          go_on(tree, walk);
          *ends[walk.at().kind()]++ = &walk;
        }
        inside_count = static_cast<std::size_t>(ends[Bvh::Child::kInner] - inside);
        leaf_count = static_cast<std::size_t>(ends[Bvh::Child::kLeaf] - leaves);
        idle_count = static_cast<std::size_t>(ends[Bvh::Child::kNone] - idle);
        for (std::size_t i = were_idle; i < idle_count; ++i) finish(*idle[i]);
        if (points_.count() >= PointWriter::kMost / 2) points_.write();
      }
    });
  }

  const Bvh& bvh_;
  IntersectCounters& counters_;
  const std::span<const Ray> rays_;
  const RayQuery query_;
  const std::span<NearestHit> hits_;
  PointWriter points_;
  std::size_t next_ = 0;  // the next ray to start
};

}  // namespace

void trace_single_rays(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters) {
  if (bvh.is_binary32() && query.exact_rays.empty()) {
    SingleRayIntersector<false>(bvh, rays, query, hits, counters).trace();
  } else {
    SingleRayIntersector<true>(bvh, rays, query, hits, counters).trace();
  }
}

}  // namespace raygate
