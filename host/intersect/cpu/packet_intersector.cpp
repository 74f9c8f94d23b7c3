#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "host/base/lanes.h"
#include "host/bvh/traversal.h"
#include "host/exact/exact.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/cpu/quad_test.h"

namespace raygate {
namespace {

/// The directions of up to 64 rays. Ray k of group g has index 8 g + k.
struct RayPacket {
  static constexpr int kGroups = 8, kRays = kGroups * kLanes;

  FloatLanes direction[3][kGroups];
  LaneMask negative[3][kGroups];  ///< by axis and group: rays whose component is negative
  LaneMask usable[kGroups];       ///< see is_usable; 0 for absent rays
  std::uint32_t octants;          ///< bit i: some usable ray may be in octant i

  [[nodiscard]] LaneMask into_octant(int octant, int group) const {
    LaneMask lanes = usable[group];
    for (int k = 0; k < 3; ++k) {
      lanes &= (octant >> k & 1) != 0 ? negative[k][group] : ~negative[k][group];
    }
    return lanes;
  }
};

/// Bounding cones of rays in one octant. Lane g belongs to group g; absent groups have radius 0.
/// Component k of each direction in group g differs from center[k][g] by at most radius[k][g].
struct Cones {
  LaneMask active[RayPacket::kGroups];  ///< rays of each group
  LaneMask groups;                      ///< groups with any ray
  FloatLanes center[3], radius[3];
  PacketBounds8 bounds8;  ///< the caller sets the cutoffs
  PacketBounds whole;     ///< bounds of all groups
};

// Sets of a packet's 64 rays: byte g holds the rays of group g.

/// Returns a word in which byte g is 1 if bit g is set, else 0.
RAYGATE_INLINE std::uint64_t ones_of(LaneMask groups) {
  const std::uint64_t bits = groups * 0x0101010101010101ull & 0x8040201008040201ull;
  return (bits + 0x7F7F7F7F7F7F7F7Full) >> 7 & 0x0101010101010101ull;
}

/// Returns a mask in which bit g is set if byte g is not 0.
RAYGATE_INLINE LaneMask groups_of(std::uint64_t rays) {
  const std::uint64_t any = ((rays & 0x7F7F7F7F7F7F7F7Full) + 0x7F7F7F7F7F7F7F7Full) | rays;
  return static_cast<LaneMask>(((any >> 7 & 0x0101010101010101ull) * 0x0102040810204080ull) >> 56);
}

RAYGATE_INLINE LaneMask rays_of(std::uint64_t rays, int group) {
  return static_cast<LaneMask>(rays >> (8 * group) & 0xFF);
}

RAYGATE_INLINE bool several(std::uint64_t set) { return (set & (set - 1)) != 0; }

/// Traversal state. Distances (t) are stored as bits of positive floats, which have the same order.
struct ConeTraversal {
  static constexpr int kGroups = RayPacket::kGroups;

  /// A subtree to visit. Of one node's children, the nearest is on top of the stack.
  struct StackEntry {
    Bvh::Child child;
    float entry;
    std::uint64_t rays;  ///< rays that may meet the subtree
  };

  const RayPacket* block;
  std::uint32_t first;  ///< index of the packet's first ray
  Cones cones;
  PacketBounds8 ray_bounds8[kGroups];    ///< bounds of each ray, for groups in `split`
  LaneMask split;                        ///< groups with valid ray_bounds8
  IntLanes low[kGroups], high[kGroups];  ///< bounds of t of each ray's nearest hit
  IntLanes primitive[kGroups];           ///< primitive of each ray's nearest hit; -1: none
  IntLanes skip_id[kGroups];             ///< primitive that each ray ignores; -1: none
  IntLanes enough[kGroups];              ///< distance; a hit surely nearer than this ends the ray
  std::uint64_t going;                   ///< rays that continue
  float cutoff;                          ///< boxes beyond this are skipped
  int depth;                             ///< number of entries of the stack
  StackEntry stack[Bvh::kStackSize];

  [[nodiscard]] std::uint32_t number(int group, int lane) const {
    return first + static_cast<std::uint32_t>(group * kLanes + lane);
  }
  /// Returns bounds of t of a ray's nearest hit.
  [[nodiscard]] Interval t(int group, int lane) const {
    return {std::bit_cast<float>(low[group][lane]), std::bit_cast<float>(high[group][lane])};
  }
};

/// Returns a cutoff for each ray: at least cutoff_beyond(high) for active rays, -1 for others.
RAYGATE_INLINE FloatLanes cutoffs_beyond(const IntLanes& high, LaneMask active) {
  constexpr float kGrow = 1.0f + 0x1p-20f;
  const IntLanes going = lanes_of(active);
  return going ? reinterpret_cast<FloatLanes>(high) * kGrow : FloatLanes{} - 1.0f;
}

/// Updates the cutoffs of a group after changes of `high` and `cones.active`.
RAYGATE_INLINE void shorten(ConeTraversal& walk, int group) {
  Cones& cones = walk.cones;
  const FloatLanes cutoffs = cutoffs_beyond(walk.high[group], cones.active[group]);
  cones.bounds8.cutoff[group] = largest_of(cutoffs);
  if ((walk.split >> group & 1) != 0) walk.ray_bounds8[group].cutoff = cutoffs;
  walk.going &= ~(std::uint64_t{0xFF & ~cones.active[group]} << (8 * group));
}

constexpr std::size_t kRayWords = 6;

/// Loads the directions of four rays, by component, from the rays' words. Each load includes the
/// word before the direction.
RAYGATE_INLINE void load_directions(const float* words, FloatQuad (&components)[3]) {
  static_assert(sizeof(Ray) == kRayWords * sizeof(float) &&
                offsetof(Ray, direction) == 3 * sizeof(float));
  FloatQuad rows[kQuad];
  for (std::size_t i = 0; i < kQuad; ++i) rows[i] = load<FloatQuad>(words + kRayWords * i + 2);
  transpose(rows);
  for (int k = 0; k < 3; ++k) components[k] = rows[k + 1];
}

/// Loads up to 64 rays. Returns a mask of the rays that are usable but not scaled.
std::uint64_t load_packet(std::span<const Ray> rays, RayPacket& block) {
  return in_vectors([&](auto) RAYGATE_BODY {
    LaneMask positive[3] = {}, negative[3] = {};  // by axis: rays of any group with such components
    std::uint64_t unscaled = 0;
    for (int group = 0; group < RayPacket::kGroups; ++group) {
      const std::size_t begin = std::size_t(group) * kLanes;
      const std::size_t count =
          begin < rays.size() ? std::min<std::size_t>(kLanes, rays.size() - begin) : 0;
      auto words = reinterpret_cast<const float*>(rays.data() + begin);
      float padded[kRayWords * kLanes];  // repeats the last ray beyond the end
      if (count < kLanes) {
        for (std::size_t i = 0; i < kLanes; ++i) {
          std::memcpy(padded + kRayWords * i, &rays[std::min(begin + i, rays.size() - 1)],
                      sizeof(Ray));
        }
        words = padded;
      }
      for (std::size_t line = 0; line < 3; ++line) {  // cache lines of the next packet
        __builtin_prefetch(words + kRayWords * RayPacket::kRays + 16 * line);
      }
      FloatQuad half[2][3];
      load_directions(words, half[0]);
      load_directions(words + kRayWords * kQuad, half[1]);
      IntLanes largest = {};  // largest magnitude of each ray, as bits of a float
      for (int k = 0; k < 3; ++k) {
        const FloatLanes d = join(half[0][k], half[1][k]);
        block.direction[k][group] = d;
        block.negative[k][group] = sign_mask(d < 0.0f);
        const IntLanes size = reinterpret_cast<IntLanes>(d) & 0x7FFFFFFF;
        largest = size > largest ? size : largest;
      }
      const LaneMask usable =
          ((1u << count) - 1) & ~sign_mask((largest >= 0x7F800000) | (largest == 0));
      const IntLanes scaled = (largest >= 0x3F800000) & (largest < 0x40000000);
      block.usable[group] = usable;
      unscaled |= std::uint64_t{usable & ~sign_mask(scaled)} << (8 * group);
      for (int k = 0; k < 3; ++k) {
        positive[k] |= usable & ~block.negative[k][group];
        negative[k] |= usable & block.negative[k][group];
      }
    }
    block.octants = 0;
    for (int octant = 0; octant < 8; ++octant) {
      bool possible = true;
      for (int k = 0; k < 3; ++k) {
        possible = possible && ((octant >> k & 1) != 0 ? negative[k] : positive[k]) != 0;
      }
      if (possible) block.octants |= 1u << octant;
    }
    return unscaled;
  });
}

/// Computes the cones and bounds of the rays in `cones.active`, which must be in this octant.
void make_cones(const RayPacket& block, const glm::vec3& origin, int octant, Cones& cones) {
  in_vectors([&](auto) RAYGATE_BODY {
    // Each rounding changes a value by a factor of at most 1 + 2^-24.
    constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
    cones.groups = 0;
    FloatLanes off[3][RayPacket::kGroups];
    for (int g = 0; g < RayPacket::kGroups; ++g) {
      const LaneMask active = cones.active[g];
      if (active == 0) {
        for (int k = 0; k < 3; ++k) {
          cones.center[k][g] = 0.0f;
          off[k][g] = FloatLanes{};
        }
        continue;
      }
      cones.groups |= 1u << g;
      const int low = std::countr_zero(active), high = 31 - std::countl_zero(active);
      const IntLanes taken = lanes_of(active);
      for (int k = 0; k < 3; ++k) {
        const FloatLanes& d = block.direction[k][g];
        const float middle = 0.5f * (d[low] + d[high]);
        cones.center[k][g] = middle;
        const FloatLanes distance = absolute(d - middle);
        off[k][g] = taken ? distance : FloatLanes{};
      }
    }
    cones.whole.octant = octant;
    const IntLanes present = lanes_of(cones.groups);
    for (int k = 0; k < 3; ++k) {
      transpose(off[k]);
      FloatLanes largest_off = off[k][0];
      for (int lane = 1; lane < kLanes; ++lane) largest_off = maximum(off[k][lane], largest_off);
      cones.radius[k] = present ? kUp * largest_off : FloatLanes{};
      const FloatLanes size = absolute(cones.center[k]);
      const FloatLanes largest = (size + cones.radius[k]) * kUp;
      FloatLanes smallest = (size - cones.radius[k]) * kDown;
      smallest = smallest > 0.0f ? smallest : FloatLanes{};
      cones.bounds8.set(k, octant, smallest, largest);
      // The inverse of the largest value is the smallest, and vice versa.
      const float sign = (octant >> k & 1) != 0 ? -1.0f : 1.0f;
      const FloatLanes never = FloatLanes{} - std::numeric_limits<float>::infinity();
      const FloatLanes near = present ? -sign * cones.bounds8.inverse_near[k] : never;
      const FloatLanes far = present ? sign * cones.bounds8.inverse_far[k] : never;
      cones.whole.origin[k] = origin[k];
      cones.whole.inverse_near[k] = -sign * largest_of(near);
      cones.whole.inverse_far[k] = sign * largest_of(far);
    }
  });
}

/// Sets ray_bounds8 of a group: the tightest bounds of each of its rays, one ray per lane.
RAYGATE_INLINE void split_group(ConeTraversal& walk, int group) {
  PacketBounds8& bounds8 = walk.ray_bounds8[group];
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  for (int k = 0; k < 3; ++k) {
    const FloatLanes size = absolute(walk.block->direction[k][group]);
    bounds8.set(k, walk.cones.whole.octant, size * kDown, size * kUp);
  }
  bounds8.cutoff = cutoffs_beyond(walk.high[group], walk.cones.active[group]);
  walk.split |= 1u << group;
}

/// Returns a mask of the children that any of `rays` may meet; `groups` are the groups of these
/// rays. Sets entry[i] to a lower bound of the distance at which a ray enters child i.
template <Vectors kCode>
RAYGATE_INLINE LaneMask meet_any(const ConeTraversal& walk, const Bvh::Node& node,
                                 std::uint64_t rays, LaneMask groups, FloatLanes& entry) {
  const Cones& cones = walk.cones;
  if (several(groups)) return intersect_children<kCode>(cones.whole, node, walk.cutoff, entry);
  const int only = std::countr_zero(groups);
  if (several(rays) || (walk.split >> only & 1) == 0) {
    const PacketBounds bounds = bounds_of(cones.bounds8, only, cones.whole);
    return intersect_children<kCode>(bounds, node, cones.bounds8.cutoff[only], entry);
  }
  const int lane = std::countr_zero(rays_of(rays, only));
  const PacketBounds8& bounds8 = walk.ray_bounds8[only];
  return intersect_children<kCode>(bounds_of(bounds8, lane, cones.whole), node,
                                   bounds8.cutoff[lane], entry);
}

/// Inserts a child into the stack, whose entries are sorted from `bottom` up, the nearest last.
RAYGATE_INLINE void push(ConeTraversal& walk, const BvhView& tree, int bottom,
                         const ConeTraversal::StackEntry& next) {
  tree.prefetch(next.child);
  int place = walk.depth++;
  for (; place > bottom && walk.stack[place - 1].entry < next.entry; --place) {
    walk.stack[place] = walk.stack[place - 1];
  }
  walk.stack[place] = next;
}

/// Up to this many rays are tested against a node one by one if they are in several groups. Without
/// this, light rays of `build/lab rays` have 0.7 times the rate on sphereflake, 0.85 on landscape.
constexpr int kFewRays = 8;

/// Does the work of step_through for a few rays.
template <Vectors kCode>
RAYGATE_INLINE void step_one_by_one(ConeTraversal& walk, const BvhView& tree, const Bvh::Node& node,
                                    std::uint64_t rays) {
  FloatLanes entry = FloatLanes{} + std::numeric_limits<float>::infinity();
  LaneMask met[kFewRays] = {}, any = 0;
  std::uint64_t ray[kFewRays] = {};
  int count = 0;
  for (const int number : SetBits(rays)) {
    const int g = number / kLanes, lane = number % kLanes;
    if ((walk.split >> g & 1) == 0) split_group(walk, g);
    const PacketBounds8& bounds8 = walk.ray_bounds8[g];
    FloatLanes its_entry;
    met[count] = intersect_children<kCode>(bounds_of(bounds8, lane, walk.cones.whole), node,
                                           bounds8.cutoff[lane], its_entry);
    const IntLanes meets = lanes_of(met[count]);
    entry = (meets & (its_entry < entry)) ? its_entry : entry;
    any |= met[count];
    ray[count++] = std::uint64_t{1} << number;
  }
  const int bottom = walk.depth;
  for (const int i : SetBits(any)) {
    std::uint64_t its_rays = 0;
    for (int r = 0; r < kFewRays; ++r) its_rays |= (met[r] >> i & 1) != 0 ? ray[r] : 0;
    push(walk, tree, bottom, {node.child[i], entry[i], its_rays});
  }
}

/// Pushes the children of a node that the rays may meet. If the rays' common bounds meet several
/// children, each group is tested; if a group's cone meets several, each of its rays is tested.
template <Vectors kCode>
RAYGATE_INLINE void step_through(ConeTraversal& walk, const BvhView& tree, std::uint32_t index,
                                 std::uint64_t rays, LaneMask groups) {
  constexpr int kFew = 1;  // up to this number of met children, groups and rays are not separated
  Bvh::Node room;
  const Bvh::Node& node = tree.node(index, room);
  if (several(groups) && std::popcount(rays) <= kFewRays) {
    step_one_by_one<kCode>(walk, tree, node, rays);
    return;
  }
  const Cones& cones = walk.cones;
  const PacketBounds& whole = cones.whole;
  FloatLanes entry, unused;
  LaneMask met = meet_any<kCode>(walk, node, rays, groups, entry);
  LaneMask in[Bvh::kWidth];
  const bool ask = several(groups) && std::popcount(met) > kFew;
  std::uint64_t counts = 0;  // byte g: number of children that group g meets
  for (const int i : SetBits(met)) {
    in[i] = groups;
    if (ask || (several(groups) && node.child[i].count != 0)) {
      in[i] &= intersect_child<kCode>(cones.bounds8, whole.origin, whole.octant, node, i, unused);
    }
    counts += ones_of(in[i]);
  }
  LaneMask divided = groups_of((counts + (0x7F - kFew) * ones_of(0xFF)) & 0x80 * ones_of(0xFF));
  for (const int g : SetBits(divided)) {
    if (!several(rays_of(rays, g))) {
      divided &= ~(1u << g);
    } else if ((walk.split >> g & 1) == 0) {
      split_group(walk, g);
    }
  }
  const int bottom = walk.depth;
  for (const int i : SetBits(met)) {
    ConeTraversal::StackEntry next = {node.child[i], entry[i], rays & 0xFF * ones_of(in[i])};
    for (const int g : SetBits(divided & in[i])) {
      const std::uint64_t missed = 0xFF & ~intersect_child<kCode>(walk.ray_bounds8[g], whole.origin,
                                                                  whole.octant, node, i, unused);
      next.rays &= ~(missed << (8 * g));
    }
    if (next.rays == 0) continue;
    push(walk, tree, bottom, next);
  }
}

/// Returns the dot products of eight directions with one plane of a triangle in a record.
RAYGATE_INLINE FloatLanes side_of(const FloatLanes (&direction)[3], const QuadRecord& record,
                                  int plane, int triangle) {
  return (direction[0] * record.word(plane, 0, triangle) +
          direction[1] * record.word(plane, 1, triangle)) +
         direction[2] * record.word(plane, 2, triangle);
}

/// Replaces bounds of |d|, in `low` and `high`, by bounds of t = |d| / V. V, the product of
/// direction and normal, is positive and in [least, most]; `least` may be negative. kUp and kDown
/// cover four roundings. A quotient that underflows is between 0 and the smallest normal float.
template <class Lanes>
RAYGATE_INLINE void bound_distance(Lanes& low, Lanes& high, const Lanes& least, const Lanes& most) {
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  constexpr float kSmallest = std::numeric_limits<float>::min();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  low = kDown * low / most;
  high = kUp * high / least;
  low = low > kSmallest ? low : Lanes{};
  high = high > kSmallest ? high : Lanes{} + kSmallest;
  high = least > 0.0f ? high : Lanes{} + kInfinity;
}

/// Result of testing a group's rays against a triangle in float32, one ray per lane, or a ray
/// against a leaf's triangles, one triangle per lane.
template <class Lanes>
struct Verdict {
  LaneMask hit;     ///< sure hits, in front of the origin
  LaneMask open;    ///< sure hits and doubts
  Lanes low, high;  ///< bounds of t of sure hits, for a group as bits of floats
};

template <Vectors kCode>
RAYGATE_INLINE void test_group(const ConeTraversal& walk, const QuadRecord& record, int triangle,
                               int group, LaneMask tested, Verdict<IntLanes>& verdict) {
  const auto& from = walk.block->direction;
  const FloatLanes direction[3] = {from[0][group], from[1][group], from[2][group]};
  FloatLanes worst = side_of(direction, record, 0, triangle);  // the least product of the edges
  for (int plane = 1; plane < 3; ++plane) {
    worst = minimum(side_of(direction, record, plane, triangle), worst);
  }
  const float bound = record.bounds[triangle];
  verdict.open = tested & ~sign_mask<kCode>(worst < -bound);
  verdict.hit = 0;
  if (verdict.open == 0) return;
  verdict.hit = verdict.open & sign_mask<kCode>(worst > bound);
  const FloatLanes v = side_of(direction, record, QuadRecord::kNormal, triangle);
  FloatLanes low = FloatLanes{} + record.low[triangle], high = FloatLanes{} + record.high[triangle];
  const float v_bound = record.normal_bound[triangle];
  bound_distance(low, high, v - v_bound, v + v_bound);
  verdict.low = bits_in(low);
  verdict.high = bits_in(high);
}

/// Returns whether so few rays reach a leaf that tests ray by ray are faster. Without such tests,
/// `make speed` has 6 to 13 % fewer camera and shadow rays per second on sphere and landscape, and
/// 11 % fewer camera rays on teapot.
RAYGATE_INLINE bool is_sparse(std::uint64_t rays, LaneMask groups, std::uint32_t triangles) {
  return static_cast<std::uint32_t>(std::popcount(rays)) <
         2 * static_cast<std::uint32_t>(std::popcount(groups)) * triangles;
}

RAYGATE_INLINE void test_ray(const ConeTraversal& walk, const QuadRecord& record, int group,
                             int lane, LaneMask there, Verdict<FloatQuad>& verdict) {
  const auto& from = walk.block->direction;
  FloatLanes sides[2] = {};  // for planes 0 and 1, then 2 and 3, four triangles each
  for (int pair = 0; pair < 2; ++pair) {
    const auto& planes = record.planes[pair];
    const FloatLanes x = load<FloatLanes>(planes[0]), y = load<FloatLanes>(planes[1]),
                     z = load<FloatLanes>(planes[2]);
    sides[pair] = (from[0][group][lane] * x + from[1][group][lane] * y) + from[2][group][lane] * z;
  }
  const FloatQuad worst =
      minimum(FloatQuad(low_half(sides[1])),
              minimum(FloatQuad(low_half(sides[0])), FloatQuad(high_half(sides[0]))));
  const FloatQuad bound = load<FloatQuad>(record.bounds);
  verdict.open = there & ~sign_mask(worst < -bound);
  verdict.hit = 0;
  if (verdict.open == 0) return;
  verdict.hit = verdict.open & sign_mask(worst > bound);
  const FloatQuad v = high_half(sides[1]), v_bound = load<FloatQuad>(record.normal_bound);
  verdict.low = load<FloatQuad>(record.low);
  verdict.high = load<FloatQuad>(record.high);
  bound_distance(verdict.low, verdict.high, v - v_bound, v + v_bound);
}

/// Entry of the cache of leaves: a leaf as seen from the rays' origin.
struct CachedLeaf {
  std::uint32_t first = NearestHit::kNone;  ///< first primitive; kNone: an empty entry
  LaneMask there;                           ///< triangles that rays can hit
  QuadRecord record;
};
constexpr int kCacheBits = 5;  ///< log2 of the number of entries

constexpr std::int32_t kFarthest = 0x7F7FFFFF;  // the largest float

/// Loads one option of a query for the rays of a group. Lanes beyond the last ray do not change.
template <class Wish>
RAYGATE_INLINE void load_group(std::span<const Wish> wishes, std::uint32_t first, IntLanes& lanes) {
  static_assert(sizeof(Wish) == sizeof(std::int32_t));
  if (first + kLanes <= wishes.size()) {
    std::memcpy(&lanes, &wishes[first], sizeof lanes);
  } else {
    std::memcpy(&lanes, &wishes[first], (wishes.size() - first) * sizeof(Wish));
  }
}

/// Traces packets. A packet has eight groups of eight rays, each with a bounding cone. At a leaf, a
/// QuadRecord of its triangles is computed in float32 and tested against the rays that reach the
/// leaf. Exact arithmetic resolves doubts of float32.
class PacketIntersector {
 public:
  PacketIntersector(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                    std::span<NearestHit> hits, IntersectCounters& counters)
      : bvh_(bvh),
        counters_(counters),
        origin_(rays[0].origin),
        rays_(rays),
        query_(query),
        hits_(hits),
        points_(bvh, rays, true, hits) {}

  /// Traces all rays. Returns the number of points computed.
  std::uint64_t trace() {
    assert(std::ranges::all_of(rays_, [&](const Ray& ray) { return ray.origin == origin_; }));
    RayPacket block;
    ConeTraversal walk;
    walk.block = &block;
    for (std::size_t first = 0; first < rays_.size(); first += RayPacket::kRays) {
      const std::size_t count = std::min<std::size_t>(RayPacket::kRays, rays_.size() - first);
      const std::uint64_t unscaled = load_packet(rays_.subspan(first, count), block);
      if (unscaled != 0) throw_unscaled(rays_[first + std::countr_zero(unscaled)]);
      walk.first = static_cast<std::uint32_t>(first);
      for (const int octant : SetBits(block.octants)) {
        for (int g = 0; g < ConeTraversal::kGroups; ++g) {
          walk.cones.active[g] = block.into_octant(octant, g);
        }
        make_cones(block, origin_, octant, walk.cones);
        if (walk.cones.groups == 0) continue;
        begin(walk);
        traverse(walk);
        finish(walk);
      }
      if (points_.count() > PointWriter::kMost - RayPacket::kRays) points_.write();
    }
    points_.write();
    return points_.written();
  }

 private:
  /// Initialises a traversal, except for its cones.
  void begin(ConeTraversal& walk) const {
    in_vectors([&](auto) RAYGATE_BODY {
      const std::span limits = query_.t_max, enough = query_.any_hit_before;
      const std::span skip_id = query_.skip_ids;
      walk.split = 0;
      walk.going = 0;
      walk.cones.bounds8.cutoff = FloatLanes{} - 1.0f;
      for (const int g : SetBits(walk.cones.groups)) {
        walk.primitive[g] = IntLanes{} - 1;
        IntLanes end = IntLanes{} + kFarthest;
        const std::uint32_t first = walk.number(g, 0);
        if (!limits.empty()) {
          load_group(limits, first, end);
          end = end < kFarthest ? end : IntLanes{} + kFarthest;
        }
        walk.low[g] = walk.high[g] = end;
        if (!enough.empty()) load_group(enough, first, walk.enough[g]);
        if (!skip_id.empty()) load_group(skip_id, first, walk.skip_id[g]);
        walk.going |= std::uint64_t{walk.cones.active[g]} << (8 * g);
        shorten(walk, g);
      }
      walk.cutoff = largest_of(walk.cones.bounds8.cutoff);
      walk.depth = 0;
      walk.stack[walk.depth++] = {{0, 0}, 0.0f, walk.going};
    });
  }

  /// Tests the leaf's triangles in `there` against the rays, one triangle and group at a time. In
  /// `changed`, sets the bits of the groups whose nearest hits change.
  template <Vectors kCode>
  RAYGATE_INLINE void test_groups(ConeTraversal& walk, const QuadRecord& record,
                                  const Bvh::Child& leaf, LaneMask there, std::uint64_t rays,
                                  LaneMask& changed) {
    for (const int i : SetBits(there)) {
      const auto primitive = static_cast<std::int32_t>(leaf.first) + i;
      for (const int g : SetBits(groups_of(rays))) {
        const LaneMask tested = rays_of(rays, g);
        Verdict<IntLanes> verdict;
        test_group<kCode>(walk, record, i, g, tested, verdict);
        count(static_cast<std::uint64_t>(std::popcount(tested)), verdict.hit, verdict.open);
        if (!query_.work.empty()) {
          for (const int lane : SetBits(tested)) {
            count_work(walk, g, lane, 1, (verdict.open & ~verdict.hit) >> lane & 1);
          }
        }
        if (verdict.open == 0) continue;
        if (!query_.skip_ids.empty()) {
          verdict.open &= ~sign_mask<kCode>(walk.skip_id[g] == primitive);
        }
        const LaneMask sure = verdict.open & verdict.hit;
        const LaneMask nearer = sure & sign_mask<kCode>(verdict.high < walk.low[g]);
        if (nearer != 0) {
          const IntLanes take = lanes_of(nearer);
          walk.low[g] = take ? verdict.low : walk.low[g];
          walk.high[g] = take ? verdict.high : walk.high[g];
          walk.primitive[g] = take ? IntLanes{} + primitive : walk.primitive[g];
          changed |= 1u << g;
        }
        LaneMask open =
            verdict.open & ~nearer & ~(sure & sign_mask<kCode>(verdict.low > walk.high[g]));
        for (const int lane : SetBits(open)) {
          const Interval t = {std::bit_cast<float>(verdict.low[lane]),
                              std::bit_cast<float>(verdict.high[lane])};
          if (resolve(walk, g, lane, primitive, (sure >> lane & 1) != 0, t)) changed |= 1u << g;
        }
      }
    }
  }

  /// Tests as test_groups() does, but one ray at a time.
  RAYGATE_INLINE void test_rays(ConeTraversal& walk, const QuadRecord& record,
                                const Bvh::Child& leaf, LaneMask there, std::uint64_t rays,
                                LaneMask& changed) {
    const auto triangles = static_cast<std::uint32_t>(std::popcount(there));
    for (const int ray : SetBits(rays)) {
      const int g = ray / kLanes, lane = ray % kLanes;
      Verdict<FloatQuad> verdict;
      test_ray(walk, record, g, lane, there, verdict);
      count(triangles, verdict.hit, verdict.open);
      if (!query_.work.empty()) {
        count_work(walk, g, lane, triangles, std::popcount(verdict.open & ~verdict.hit));
      }
      for (const int i : SetBits(verdict.open)) {
        const auto primitive = static_cast<std::int32_t>(leaf.first) + i;
        if (!query_.skip_ids.empty() && walk.skip_id[g][lane] == primitive) continue;
        const bool sure = (verdict.hit >> i & 1) != 0;
        const Interval t = {verdict.low[i], verdict.high[i]};
        if (sure && t.low > std::bit_cast<float>(walk.high[g][lane])) continue;
        if (sure && t.high < std::bit_cast<float>(walk.low[g][lane])) {
          walk.low[g][lane] = std::bit_cast<std::int32_t>(verdict.low[i]);
          walk.high[g][lane] = std::bit_cast<std::int32_t>(verdict.high[i]);
          walk.primitive[g][lane] = primitive;
        } else if (!resolve(walk, g, lane, primitive, sure, t)) {
          continue;
        }
        changed |= 1u << g;
      }
    }
  }

  RAYGATE_INLINE void count(std::uint64_t tests, LaneMask hit, LaneMask open) {
    HitCounters& counters = counters_.hit;
    counters.tests += tests;
    if (open == 0) return;
    counters.hits += static_cast<std::uint64_t>(std::popcount(hit));
    counters.edge_doubts += static_cast<std::uint64_t>(std::popcount(open & ~hit));
  }
  void count_work(const ConeTraversal& walk, int group, int lane, std::uint32_t tests,
                  std::uint32_t doubts) const {
    query_.work[walk.number(group, lane)] += {tests, doubts};
  }

  /// Traverses the BVH, nearest children first, and tests its leaves.
  void traverse(ConeTraversal& walk) {
    in_vectors([&](auto code) RAYGATE_BODY {
      const BvhView tree(bvh_);
      const bool ending = !query_.any_hit_before.empty();
      Cones& cones = walk.cones;
      while (walk.depth > 0 && walk.going != 0) {
        const ConeTraversal::StackEntry item = walk.stack[--walk.depth];
        if (item.entry > walk.cutoff) continue;
        const std::uint64_t rays =
            item.rays & walk.going &
            0xFF * ones_of(sign_mask<code()>(cones.bounds8.cutoff >= item.entry));
        if (rays == 0) continue;
        const LaneMask groups = groups_of(rays);
        if (item.child.count == 0) {
          step_through<code()>(walk, tree, item.child.first, rays, groups);
          continue;
        }
        const CachedLeaf& leaf = cached(tree, item.child);
        LaneMask changed = 0;
        if (is_sparse(rays, groups, item.child.count)) {
          test_rays(walk, leaf.record, item.child, leaf.there, rays, changed);
        } else {
          test_groups<code()>(walk, leaf.record, item.child, leaf.there, rays, changed);
        }
        if (changed == 0) continue;
        for (const int g : SetBits(changed)) {
          if (ending) {
            const LaneMask ended = cones.active[g] & ~sign_mask<code()>(walk.primitive[g]) &
                                   sign_mask<code()>(walk.high[g] < walk.enough[g]);
            cones.active[g] &= ~ended;
            counters_.ended_early += static_cast<std::uint64_t>(std::popcount(ended));
          }
          shorten(walk, g);
        }
        walk.cutoff = largest_of(cones.bounds8.cutoff);
      }
    });
  }

  /// Returns the leaf's entry in the cache. Computes it if missing, in place of another leaf's.
  RAYGATE_INLINE const CachedLeaf& cached(const BvhView& tree, const Bvh::Child& leaf) {
    CachedLeaf& cached = leaves_[leaf.first * 0x9E3779B1u >> (32 - kCacheBits)];
    if (cached.first == leaf.first) return cached;
    cached.first = leaf.first;
    Bvh::LeafRoom room;
    const float* const corners = tree.corners_of(leaf, room);
    bvh_.is_binary32() ? make_quad_record<false>(origin_, corners, leaf.count, cached.record)
                       : make_quad_record<true>(origin_, corners, leaf.count, cached.record);
    cached.there = (1u << leaf.count) - 1;
    if (cached.record.unsure != 0) resolve_sides(leaf, cached);
    return cached;
  }

  /// Decides exactly on which side of a triangle the origin lies if float32 is not sure. Removes
  /// triangles whose plane contains the origin, since no ray hits them.
  void resolve_sides(const Bvh::Child& leaf, CachedLeaf& cached) const {
    for (const int i : SetBits(cached.record.unsure)) {
      const int side =
          orient3d(origin_, bvh_.corners_of(leaf.first + static_cast<std::uint32_t>(i)));
      if (side == 0) {
        cached.there &= ~(1u << i);
      } else {
        set_side(cached.record, i, side);
      }
    }
  }

  /// Decides exactly whether a primitive is the ray's nearest hit, and returns whether it is.
  /// `sure`: the primitive is hit, at a distance in `t`; only the order of hits must be decided.
  bool resolve(ConeTraversal& walk, int group, int lane, std::int32_t primitive, bool sure,
               const Interval& t) {
    const std::uint32_t number = walk.number(group, lane);
    NearestHit best;
    if (walk.primitive[group][lane] >= 0) {
      best.primitive = static_cast<std::uint32_t>(walk.primitive[group][lane]);
      best.t = walk.t(group, lane);
      counters_.hit.depth_doubts += sure;
    }
    const NearestHit hit = {.primitive = static_cast<std::uint32_t>(primitive), .t = t};
    if (!take_if_nearest(bvh_, rays_[number], query_.t_max_of(number), hit, sure, best,
                         counters_)) {
      return false;
    }
    walk.low[group][lane] = std::bit_cast<std::int32_t>(float_below(best.t.low));
    walk.high[group][lane] = std::bit_cast<std::int32_t>(float_above(best.t.high));
    walk.primitive[group][lane] = primitive;
    return true;
  }

  /// Writes the nearest hits. Computes their points immediately, or adds the hits to `points_`.
  void finish(const ConeTraversal& walk) {
    in_vectors([&](auto code) RAYGATE_BODY {
      const auto& block = walk.block->direction;
      const bool with_points = query_.with_points;
      for (const int g : SetBits(walk.cones.groups)) {
        double bounds[kLanes][2];
        for (std::size_t half = 0; half < 2; ++half) {
          const auto quad = [&](const IntLanes& bits) RAYGATE_BODY {
            const auto lanes = reinterpret_cast<const FloatLanes&>(bits);
            return widen<code()>(half == 0 ? FloatQuad(low_half(lanes)) : high_half(lanes));
          };
          const DoubleQuad low = quad(walk.low[g]), high = quad(walk.high[g]);
          store(bounds[kQuad * half], __builtin_shufflevector(low, high, 0, 4, 1, 5));
          store(bounds[kQuad * half + 2], __builtin_shufflevector(low, high, 2, 6, 3, 7));
        }
        LaneMask met = 0xFF & ~sign_mask<code()>(walk.primitive[g]);
        const std::uint32_t number = walk.number(g, 0);
        const auto primitives = reinterpret_cast<const std::uint32_t*>(&walk.primitive[g]);
        const auto write_hit = [&](std::uint32_t lane) RAYGATE_BODY {
          NearestHit& hit = hits_[number + lane];
          hit.primitive = primitives[lane];
          std::memcpy(&hit.t, bounds[lane], sizeof hit.t);
        };
        if (with_points && met == 0xFF &&
            sign_mask<code()>(walk.primitive[g] == walk.primitive[g][0]) == met) {
          const FloatLanes directions[3] = {block[0][g], block[1][g], block[2][g]};
          if (points_.write_group<code()>(number, primitives[0], directions)) {
            for (std::uint32_t lane = 0; lane < kLanes; ++lane) write_hit(lane);
            continue;
          }
        }
        for (const int i : SetBits(met)) {
          const auto lane = static_cast<std::uint32_t>(i);
          write_hit(lane);
          if (with_points) points_.add(number + lane, primitives[lane]);
        }
      }
    });
  }

  const Bvh& bvh_;
  IntersectCounters& counters_;
  const glm::vec3 origin_;
  const std::span<const Ray> rays_;
  const RayQuery query_;
  const std::span<NearestHit> hits_;
  PointWriter points_;
  CachedLeaf leaves_[1 << kCacheBits];  // indexed by a hash of the leaf
};

}  // namespace

void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters) {
  counters.hit.plane_tests += PacketIntersector(bvh, rays, query, hits, counters).trace();
}

}  // namespace raygate
