#include "host/render/cone_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "host/accel/wide_bvh.h"
#include "host/hit/cpu_burst_unit.h"

// Why a group is never wrongly spared a record
//
// Let F be an edge's words, E the exact edge, b its bound, u = 2^-24, C the group's middle and R
// its radius, I one of its rays over its pace; components are below 8. As polygon_record.cpp has it
// for components below 2, float32(C . F) is off C . F by less than 24.0001 u |F|_1, I . E is off I
// . F by less than 8.03 u |F|_1, and b >= kEdgeBound u |F|_1. And |I . F - C . F| <= R |F|_1. So
// where float32(C . F) < -b (4.1 + R / (kEdgeBound u)), I . E < 0 for all the group's rays: the
// edge has them all on its wrong side, and all miss. `slack`, the factor of b, is rounded up by
// 2^-20 of itself, which covers the roundings of slack and of the product.

namespace raygate {
namespace {

constexpr std::int32_t kFarthest = 0x7F7FFFFF;  // the largest float
constexpr std::int32_t kInfinite = 0x7F800000;
constexpr std::int32_t kSmallestNormal = 0x00800000;
constexpr int kFew = 2;  // of a node's children: more ask which groups meet them

constexpr int kMaxGrazing = 12, kTErrorUnit = 6;  // as in BurstUnit

float float_below(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest > x ? std::nextafter(nearest, -1.0f) : nearest;
}
float float_above(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

RAYGATE_INLINE float float_of(std::int32_t bits) { return std::bit_cast<float>(bits); }
RAYGATE_INLINE std::int32_t bits_of(float x) { return std::bit_cast<std::int32_t>(x); }

/// -1 in the lanes of the mask, 0 in the others.
RAYGATE_INLINE void lanes_of(LaneMask mask, IntLanes& lanes) {
  constexpr IntLanes kBit = {1, 2, 4, 8, 16, 32, 64, 128};
  lanes = ((IntLanes{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
}

RAYGATE_INLINE std::int32_t largest_of(const IntLanes& lanes) {
  IntLanes x = lanes;
  IntLanes other = __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  x = x > other ? x : other;
  return x[0];
}

/// Of floats, the positive ones among which are the largest.
RAYGATE_INLINE float largest_of(const FloatLanes& lanes) {
  return float_of(largest_of(reinterpret_cast<IntLanes>(lanes)));
}

/// Where boxes end to matter for rays of these paces that end at `high` (see PacketTraversal).
RAYGATE_INLINE void cutoffs_beyond(const IntLanes& high, const FloatLanes& pace, LaneMask active,
                                   FloatLanes& cutoffs) {
  constexpr float kGrow = 1.0f + 0x1p-20f;
  IntLanes going;
  lanes_of(active, going);
  cutoffs = going ? reinterpret_cast<FloatLanes>(high) * pace * kGrow : FloatLanes{} - 1.0f;
}

/// The largest exponent of N.
RAYGATE_INLINE std::int32_t largest_exponent(const glm::vec3& n) {
  const auto magnitude = [](float x) { return bits_of(x) & 0x7FFFFFFF; };
  return std::max({magnitude(n.x), magnitude(n.y), magnitude(n.z)}) >> 23;
}

/// I . E for eight directions, its sign changed where `sign` has that bit.
RAYGATE_INLINE void side_of(const FloatLanes& x, const FloatLanes& y, const FloatLanes& z,
                            const glm::vec3& e, std::int32_t sign, FloatLanes& side) {
  const FloatLanes u = (x * e.x + y * e.y) + z * e.z;
  side = reinterpret_cast<FloatLanes>(reinterpret_cast<IntLanes>(u) ^ sign);
}

// Sets of rays: byte g holds the rays of group g.

/// Byte g is 1 where bit g is set, else 0.
RAYGATE_INLINE std::uint64_t ones_of(LaneMask groups) {
  const std::uint64_t bits = groups * 0x0101010101010101ull & 0x8040201008040201ull;
  return (bits + 0x7F7F7F7F7F7F7F7Full) >> 7 & 0x0101010101010101ull;
}

/// Bit g is set where byte g is not 0.
RAYGATE_INLINE LaneMask groups_of(std::uint64_t rays) {
  const std::uint64_t any = ((rays & 0x7F7F7F7F7F7F7F7Full) + 0x7F7F7F7F7F7F7F7Full) | rays;
  return static_cast<LaneMask>(((any >> 7 & 0x0101010101010101ull) * 0x0102040810204080ull) >> 56);
}

RAYGATE_INLINE LaneMask rays_of(std::uint64_t rays, int group) {
  return static_cast<LaneMask>(rays >> (8 * group) & 0xFF);
}

RAYGATE_INLINE bool several(std::uint64_t set) { return (set & (set - 1)) != 0; }

/// What of the tree waits to be visited.
struct Waiting {
  WideBvh::Child child;
  float entry;
  std::uint64_t rays;  // those that may meet it
};

}  // namespace

/// Everything of a walk but its cones and where it begins.
RAYGATE_LANES void set_out(const ConeSearch& search, ConeSearch::Walk& walk) {
  const auto& [limits, ignored, enough] = search.wishes_;
  FloatLanes radius = {};
  for (const FloatLanes& r : walk.cones.radius) radius = r > radius ? r : radius;
  walk.slack = static_cast<float>(1.0 + 0x1p-20) *
               (4.1f + radius * static_cast<float>(1.0 / (kEdgeBound * 0x1p-24)));
  walk.cones.beams.cutoff = FloatLanes{} - 1.0f;
  for (LaneMask left = walk.cones.groups; left != 0; left &= left - 1) {
    const int g = std::countr_zero(left);
    walk.slot[g] = IntLanes{} - 1;
    walk.low[g] = walk.high[g] = IntLanes{} + kFarthest;
    if (!limits.empty() || !ignored.empty() || !enough.empty()) {
      for (LaneMask lanes = walk.cones.active[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        const std::uint32_t ray = ConeSearch::number(walk, g, lane);
        if (!limits.empty()) {
          walk.low[g][lane] = walk.high[g][lane] = std::min(bits_of(limits[ray]), kFarthest);
        }
        if (!enough.empty()) walk.enough[g][lane] = bits_of(enough[ray]);
        if (!ignored.empty()) walk.ignored[g][lane] = static_cast<std::int32_t>(ignored[ray]);
      }
    }
    FloatLanes cutoffs;
    cutoffs_beyond(walk.high[g], walk.cones.pace[g], walk.cones.active[g], cutoffs);
    walk.cones.beams.cutoff[g] = largest_of(cutoffs);
  }
}

/// Beams around each ray of a group, as tight as can be.
RAYGATE_LANES void split_group(ConeSearch::Walk& walk, int group) {
  Beams& beams = walk.ray_beams[group];
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  const FloatLanes inverse = 1.0f / walk.cones.pace[group];
  for (int k = 0; k < 3; ++k) {
    const FloatLanes d = walk.block->direction[k][group] * inverse;
    const FloatLanes size =
        reinterpret_cast<FloatLanes>(reinterpret_cast<IntLanes>(d) & 0x7FFFFFFF);
    beams.set(k, walk.cones.whole.octant, size * kDown, size * kUp);
  }
  cutoffs_beyond(walk.high[group], walk.cones.pace[group], walk.cones.active[group], beams.cutoff);
}

/// Walks the tree, near before far, and tests what is there.
RAYGATE_LANES void walk_tree(ConeSearch& search, ConeSearch::Walk& walk) {
  const WideBvh::Node* const nodes = search.bvh_.wide().nodes().data();
  const bool ignoring = !search.wishes_.ignored.empty();
  const bool ending = !search.wishes_.enough_before.empty();
  Cones& cones = walk.cones;
  const Beam whole = cones.whole;
  const glm::vec3 origin(whole.origin[0], whole.origin[1], whole.origin[2]);
  std::uint64_t tests = 0, hits = 0, doubts = 0;
  float cutoff = largest_of(cones.beams.cutoff);
  Waiting stack[WideBvh::kStackSize];
  int depth = 0;
  LaneMask split = 0;  // groups with beams for each ray
  std::uint64_t going = 0;
  for (int g = 0; g < RayBlock::kGroups; ++g) going |= std::uint64_t{cones.active[g]} << (8 * g);
  stack[depth++] = {{0, 0}, 0.0f, going};
  while (depth > 0) {
    const Waiting item = stack[--depth];
    if (item.entry > cutoff) continue;
    const std::uint64_t rays =
        item.rays & going & 0xFF * ones_of(sign_mask(cones.beams.cutoff >= item.entry));
    if (rays == 0) continue;
    const LaneMask groups = groups_of(rays);
    if (item.child.count == 0) {
      const WideBvh::Node& node = nodes[item.child.first];
      FloatLanes entry;
      LaneMask met;
      const int only = std::countr_zero(groups);
      if (several(groups)) {
        met = meet_children(whole, node, cutoff, entry);
      } else if (several(rays) || (split >> only & 1) == 0) {
        met =
            meet_children(one_of(cones.beams, only, whole), node, cones.beams.cutoff[only], entry);
      } else {
        const int lane = std::countr_zero(rays_of(rays, only));
        met = meet_children(one_of(walk.ray_beams[only], lane, whole), node,
                            walk.ray_beams[only].cutoff[lane], entry);
      }
      // Where a beam meets more than a few children, those within it are asked one by one.
      LaneMask in[WideBvh::kWidth];
      const bool ask = several(groups) && std::popcount(met) > kFew;
      std::uint64_t counts = 0;  // byte g: how many children group g meets
      for (LaneMask left = met; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        in[i] = groups;
        if (ask || (several(groups) && node.child[i].count != 0)) {
          in[i] &= meet_beams(cones.beams, origin, whole.octant, node, i);
        }
        counts += ones_of(in[i]);
      }
      LaneMask divided = groups_of((counts + (0x7F - kFew) * ones_of(0xFF)) & 0x80 * ones_of(0xFF));
      for (LaneMask left = divided; left != 0; left &= left - 1) {
        const int g = std::countr_zero(left);
        if (!several(rays_of(rays, g))) {
          divided &= ~(1u << g);
        } else if ((split >> g & 1) == 0) {
          split_group(walk, g);
          split |= 1u << g;
        }
      }
      const int bottom = depth;
      for (; met != 0; met &= met - 1) {
        const int i = std::countr_zero(met);
        Waiting next = {node.child[i], entry[i], rays & 0xFF * ones_of(in[i])};
        for (LaneMask left = divided & in[i]; left != 0; left &= left - 1) {
          const int g = std::countr_zero(left);
          const std::uint64_t missed =
              0xFF & ~meet_beams(walk.ray_beams[g], origin, whole.octant, node, i);
          next.rays &= ~(missed << (8 * g));
        }
        if (next.rays == 0) continue;
        int place = depth++;
        for (; place > bottom && stack[place - 1].entry < next.entry; --place) {
          stack[place] = stack[place - 1];
        }
        stack[place] = next;
      }
      continue;
    }
    const PolygonRecord* records = search.records_.leaf(item.child.first, item.child.count);
    LaneMask changed = 0;
    for (std::uint32_t i = 0; i < item.child.count; ++i) {
      const PolygonRecord& record = records[i];
      if (record.d == 0.0f) continue;
      const std::int32_t sign = bits_of(record.d) & std::numeric_limits<std::int32_t>::min();
      const auto slot = static_cast<std::int32_t>(item.child.first + i);
      LaneMask left = groups;
      if ((left & (left - 1)) != 0) {
        IntLanes off = {};
        for (int k = 0; k < 3; ++k) {
          FloatLanes u;
          side_of(cones.center[0], cones.center[1], cones.center[2], record.edges[k], sign, u);
          const FloatLanes above = u + record.bounds[k] * walk.slack;
          off |= reinterpret_cast<IntLanes>(above);
        }
        left &= ~sign_mask(off);
      }
      for (; left != 0; left &= left - 1) {
        const int g = std::countr_zero(left);
        const FloatLanes &x = walk.block->direction[0][g], &y = walk.block->direction[1][g],
                         &z = walk.block->direction[2][g];
        IntLanes off = {}, on = IntLanes{} - 1;
        for (int k = 0; k < 3; ++k) {
          FloatLanes u;
          side_of(x, y, z, record.edges[k], sign, u);
          const FloatLanes above = u + record.bounds[k], below = record.bounds[k] - u;
          off |= reinterpret_cast<IntLanes>(above);  // its sign: u < -b
          on &= reinterpret_cast<IntLanes>(below);   // u > b
        }
        const LaneMask tested = rays_of(rays, g) & cones.active[g];
        tests += std::popcount(tested);
        LaneMask open = tested & ~sign_mask(off);
        if (open == 0) continue;
        FloatLanes v;
        side_of(x, y, z, record.normal, sign, v);
        const FloatLanes t = std::abs(record.d) / v;
        const auto v_bits = reinterpret_cast<IntLanes>(v);
        const auto t_bits = reinterpret_cast<IntLanes>(t);
        const IntLanes exponent = v_bits >> 23;  // negative for a V of the other sign
        IntLanes grazing = largest_exponent(record.normal) - exponent;
        on &= (exponent >= 1) & (exponent <= 254) & (grazing <= kMaxGrazing) &
              (t_bits >= kSmallestNormal) & (t_bits < kInfinite);
        if (ignoring) open &= ~sign_mask(walk.ignored[g] == slot);
        const LaneMask sure = open & sign_mask(on);
        hits += std::popcount(sure);
        doubts += std::popcount(open & ~sure);
        grazing = grazing > 0 ? grazing : IntLanes{};
        grazing = grazing < kMaxGrazing ? grazing : IntLanes{} + kMaxGrazing;
        const IntLanes margin = (IntLanes{} + (1 << kTErrorUnit)) << grazing;
        IntLanes low = t_bits - margin, high = t_bits + margin;
        low = low > 0 ? low : IntLanes{};
        high = high < kInfinite ? high : IntLanes{} + kInfinite;
        const LaneMask nearer = sure & sign_mask(high < walk.low[g]);
        const LaneMask unsettled =
            (open & ~sure) | (sure & ~nearer & ~sign_mask(low > walk.high[g]));
        if (nearer != 0) {
          IntLanes take;
          lanes_of(nearer, take);
          walk.low[g] = take ? low : walk.low[g];
          walk.high[g] = take ? high : walk.high[g];
          walk.slot[g] = take ? IntLanes{} + slot : walk.slot[g];
          changed |= 1u << g;
        }
        for (LaneMask rest = unsettled; rest != 0; rest &= rest - 1) {
          const int lane = std::countr_zero(rest);
          const Interval interval = {float_of(low[lane]), float_of(high[lane])};
          if (search.settle(walk, g, lane, slot, (sure >> lane & 1) != 0 ? &interval : nullptr)) {
            changed |= 1u << g;
          }
        }
      }
    }
    if (changed == 0) continue;
    for (; changed != 0; changed &= changed - 1) {
      const int g = std::countr_zero(changed);
      if (ending) {
        const LaneMask ended =
            cones.active[g] & ~sign_mask(walk.slot[g]) & sign_mask(walk.high[g] < walk.enough[g]);
        cones.active[g] &= ~ended;
        search.ended_early_ += static_cast<std::uint64_t>(std::popcount(ended));
      }
      FloatLanes cutoffs;
      cutoffs_beyond(walk.high[g], cones.pace[g], cones.active[g], cutoffs);
      cones.beams.cutoff[g] = largest_of(cutoffs);
      if ((split >> g & 1) != 0) walk.ray_beams[g].cutoff = cutoffs;
      going &= ~(std::uint64_t{0xFF & ~cones.active[g]} << (8 * g));
    }
    if (going == 0) break;
    cutoff = largest_of(cones.beams.cutoff);
  }
  search.counters_.tests += tests;
  search.counters_.unit_tests += tests;
  search.counters_.hits += hits;
  search.counters_.edge_doubts += doubts;
  search.counters_.misses += tests - hits - doubts;
  search.counters_.quotients += hits;
}

void ConeSearch::trace(std::span<const Ray> rays, const SearchWishes& wishes) {
  rays_ = rays;
  wishes_ = wishes;
  RayBlock block;
  Walk walk;
  walk.block = &block;
  for (std::size_t first = 0; first < rays.size(); first += RayBlock::kRays) {
    const std::size_t count = std::min<std::size_t>(RayBlock::kRays, rays.size() - first);
    load_block(rays.subspan(first, count), block);
    walk.first = static_cast<std::uint32_t>(first);
    for (std::uint32_t octants = block.octants; octants != 0; octants &= octants - 1) {
      const int octant = std::countr_zero(octants);
      for (int g = 0; g < kGroups; ++g) walk.cones.active[g] = block.into_octant(octant, g);
      make_cones(block, records_.origin(), octant, walk.cones);
      trace_cones(walk);
    }
  }
}

void ConeSearch::trace_cones(Walk& walk) {
  set_out(*this, walk);
  const LaneMask begun = walk.cones.groups;
  walk_tree(*this, walk);
  finish(walk, begun);
}

/// The last word on what float32 leaves open about a ray and a slot. `sure`: bounds of its t, or
/// nullptr where it is not even sure that it is hit. True where it is the nearest hit now.
bool ConeSearch::settle(Walk& walk, int group, int lane, std::int32_t slot, const Interval* sure) {
  const std::uint32_t ray = number(walk, group, lane);
  const auto tag = static_cast<std::uint32_t>(slot);
  const std::int32_t best = walk.slot[group][lane];
  if (best >= 0) {
    nearest_.put(ray,
                 {static_cast<std::uint32_t>(best), glm::vec3(0.0f), bounds(walk, group, lane)});
    counters_.depth_doubts += sure != nullptr;
  }
  const bool nearer = sure != nullptr
                          ? nearest_.offer(ray, rays_[ray], SureHit{0, 0, tag, {}, *sure})
                          : nearest_.offer(ray, rays_[ray], Doubt{0, 0, tag, {}});
  if (!nearer) return false;
  const Interval t = nearest_[ray].t;
  walk.low[group][lane] = bits_of(float_below(t.low));
  walk.high[group][lane] = bits_of(float_above(t.high));
  walk.slot[group][lane] = slot;
  return true;
}

Interval ConeSearch::bounds(const Walk& walk, int group, int lane) {
  return {float_of(walk.low[group][lane]), float_of(walk.high[group][lane])};
}

/// Hands the nearest hits over, with their P.
void ConeSearch::finish(const Walk& walk, LaneMask groups) {
  for (; groups != 0; groups &= groups - 1) {
    const int g = std::countr_zero(groups);
    for (LaneMask lanes = 0xFF & ~sign_mask(walk.slot[g]); lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t ray = number(walk, g, lane);
      const auto slot = static_cast<std::uint32_t>(walk.slot[g][lane]);
      nearest_.put(ray, {slot, plane_point(records_.made(slot), rays_[ray].direction),
                         bounds(walk, g, lane)});
      ++counters_.plane_tests;
      counters_.quotients += 3;
    }
  }
}

}  // namespace raygate
