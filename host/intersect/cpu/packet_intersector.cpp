#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "host/intersect/cpu/packet.h"
#include "host/intersect/cpu/packet_steps.h"
#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

constexpr std::int32_t kFarthest = 0x7F7FFFFF;  // the largest float

/// Loads the query options of a group's rays. Lanes beyond the last ray are undefined.
template <class Wish>
RAYGATE_INLINE void load_group(std::span<const Wish> wishes, std::uint32_t first, IntLanes& lanes) {
  static_assert(sizeof(Wish) == sizeof(std::int32_t));
  if (first + kLanes <= wishes.size()) {
    std::memcpy(&lanes, &wishes[first], sizeof lanes);
  } else {
    std::memcpy(&lanes, &wishes[first], (wishes.size() - first) * sizeof(Wish));
  }
}

/// Counts one test of each of these rays, and the doubts.
void count_work(RayWork (&work)[kLanes], LaneMask tested, LaneMask doubts) {
  for (int lane = 0; lane < kLanes; ++lane) {
    work[lane].tests += tested >> lane & 1;
    work[lane].doubts += doubts >> lane & 1;
  }
}

/// Planes of the triangles that the rays of a packet hit.
struct SeenPlanes {
  static constexpr int kMost = RayPacket::kRays;

  int count = 0;
  std::uint32_t primitives[kMost + 1] = {};
  std::uint8_t of_rays[RayPacket::kGroups][kLanes] = {};  ///< index of each ray's plane
  LaneMask even = 0;                                      ///< groups whose rays hit the same plane
  float words[4][kMost];                                  ///< in the format of Planes
  std::int32_t largest[kMost];                            ///< exponent field of N

  /// Returns a value of the planes that a group's rays hit, one per lane.
  template <class Word>
  [[nodiscard]] RAYGATE_INLINE auto get(const Word (&of)[kMost], int group) const {
    const std::uint8_t(&at)[kLanes] = of_rays[group];
    if ((even >> group & 1) != 0) return Vec<Word, kLanes>{} + of[at[0]];
    return Vec<Word, kLanes>{of[at[0]], of[at[1]], of[at[2]], of[at[3]],
                             of[at[4]], of[at[5]], of[at[6]], of[at[7]]};
  }
};

/// Sets pairs[i] to {first[i], second[i]}.
RAYGATE_INLINE void pair_up(const DoubleQuad& first, const DoubleQuad& second,
                            Vec<double, 2>* pairs) {
  pairs[0] = __builtin_shufflevector(first, second, 0, 4);
  pairs[1] = __builtin_shufflevector(first, second, 1, 5);
  pairs[2] = __builtin_shufflevector(first, second, 2, 6);
  pairs[3] = __builtin_shufflevector(first, second, 3, 7);
}

/// Traces packets. A packet has eight groups of eight rays, each with a bounding cone. At a leaf
/// the packet computes a QuadRecord in float32 and tests it against the groups whose cones it
/// meets. Exact arithmetic resolves doubts of float32.
class PacketIntersector {
 public:
  PacketIntersector(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                    std::span<NearestHit> hits, IntersectCounters& counters)
      : bvh_(bvh),
        counters_(counters),
        origin_(rays[0].origin),
        rays_(rays),
        query_(query),
        hits_(hits) {}

  void trace() {
    assert(std::ranges::all_of(rays_, [&](const Ray& ray) { return ray.origin == origin_; }));
    RayPacket block;
    ConeTraversal walk;
    walk.block = &block;
    for (std::size_t first = 0; first < rays_.size(); first += RayPacket::kRays) {
      const std::size_t count = std::min<std::size_t>(RayPacket::kRays, rays_.size() - first);
      const std::uint64_t unscaled = load_packet(rays_.subspan(first, count), block);
      if (unscaled != 0) throw_unscaled(rays_[first + std::countr_zero(unscaled)]);
      walk.first = static_cast<std::uint32_t>(first);
      for (std::uint32_t octants = block.octants; octants != 0; octants &= octants - 1) {
        const int octant = std::countr_zero(octants);
        for (int g = 0; g < ConeTraversal::kGroups; ++g) {
          walk.cones.active[g] = block.into_octant(octant, g);
        }
        make_cones(block, origin_, octant, walk.cones);
        if (walk.cones.groups == 0) continue;
        begin(walk);
        traverse(walk);
        finish(walk);
      }
    }
  }

 private:
  /// Initialises a traversal, except for its cones.
  void begin(ConeTraversal& walk) const {
    in_vectors([&](auto) RAYGATE_BODY {
      const std::span limits = query_.t_max, enough = query_.any_hit_before;
      const std::span skip_id = query_.skip_ids;
      slack_of(walk.cones.radius, walk.slack);
      walk.split = 0;
      walk.going = 0;
      walk.cones.bounds8.cutoff = FloatLanes{} - 1.0f;
      for (LaneMask left = walk.cones.groups; left != 0; left &= left - 1) {
        const int g = std::countr_zero(left);
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
      if (!query_.work.empty()) {
        std::memset(walk.work, 0, sizeof walk.work);
        std::memcpy(walk.started, walk.cones.active, sizeof walk.started);
      }
      walk.depth = 0;
      walk.stack[walk.depth++] = {{0, 0}, 0.0f, walk.going};
    });
  }

  /// Tests the leaf's triangles in `there` against the rays, one triangle and group at a time. Sets
  /// the bits of the groups whose nearest hits change.
  template <Vectors kCode>
  RAYGATE_INLINE void test_groups(ConeTraversal& walk, const QuadRecord& record,
                                  const Bvh::Child& leaf, LaneMask there, std::uint64_t rays,
                                  LaneMask& changed) {
    const bool skipping = !query_.skip_ids.empty(), counting = !query_.work.empty();
    HitCounters& counters = counters_.hit;
    for (; there != 0; there &= there - 1) {
      const int i = std::countr_zero(there);
      const auto primitive = static_cast<std::int32_t>(leaf.first) + i;
      LaneMask left = groups_near<kCode>(walk, record, i, groups_of(rays));
      for (; left != 0; left &= left - 1) {
        const int g = std::countr_zero(left);
        const LaneMask tested = rays_of(rays, g);
        GroupVerdict verdict;
        test_group<kCode>(walk, record, i, g, tested, verdict);
        counters.tests += static_cast<std::uint64_t>(std::popcount(tested));
        if (counting) count_work(walk.work[g], tested, verdict.open & ~verdict.hit);
        if (verdict.open == 0) continue;
        counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
        counters.edge_doubts +=
            static_cast<std::uint64_t>(std::popcount(verdict.open & ~verdict.hit));
        if (skipping) verdict.open &= ~sign_mask<kCode>(walk.skip_id[g] == primitive);
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
        for (; open != 0; open &= open - 1) {
          const int lane = std::countr_zero(open);
          const Interval t = {std::bit_cast<float>(verdict.low[lane]),
                              std::bit_cast<float>(verdict.high[lane])};
          if (resolve(walk, g, lane, primitive, (sure >> lane & 1) != 0 ? &t : nullptr)) {
            changed |= 1u << g;
          }
        }
      }
    }
  }

  /// Tests as test_groups() does, but one ray at a time.
  RAYGATE_INLINE void test_rays(ConeTraversal& walk, const QuadRecord& record,
                                const Bvh::Child& leaf, LaneMask there, std::uint64_t rays,
                                LaneMask& changed) {
    const bool skipping = !query_.skip_ids.empty(), counting = !query_.work.empty();
    HitCounters& counters = counters_.hit;
    counters.tests += static_cast<std::uint64_t>(std::popcount(rays) * std::popcount(there));
    for (; rays != 0; rays &= rays - 1) {
      const int ray = std::countr_zero(rays), g = ray / kLanes, lane = ray % kLanes;
      RayVerdict verdict;
      test_ray(walk, record, g, lane, there, verdict);
      if (counting) {
        walk.work[g][lane].tests += static_cast<std::uint32_t>(std::popcount(there));
        walk.work[g][lane].doubts +=
            static_cast<std::uint32_t>(std::popcount(verdict.open & ~verdict.hit));
      }
      if (verdict.open == 0) continue;
      counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
      counters.edge_doubts +=
          static_cast<std::uint64_t>(std::popcount(verdict.open & ~verdict.hit));
      for (LaneMask open = verdict.open; open != 0; open &= open - 1) {
        const int i = std::countr_zero(open);
        const auto primitive = static_cast<std::int32_t>(leaf.first) + i;
        if (skipping && walk.skip_id[g][lane] == primitive) continue;
        const bool sure = (verdict.hit >> i & 1) != 0;
        const Interval t = {verdict.low[i], verdict.high[i]};
        if (sure && t.low > std::bit_cast<float>(walk.high[g][lane])) continue;
        if (sure && t.high < std::bit_cast<float>(walk.low[g][lane])) {
          walk.low[g][lane] = std::bit_cast<std::int32_t>(verdict.low[i]);
          walk.high[g][lane] = std::bit_cast<std::int32_t>(verdict.high[i]);
          walk.primitive[g][lane] = primitive;
        } else if (!resolve(walk, g, lane, primitive, sure ? &t : nullptr)) {
          continue;
        }
        changed |= 1u << g;
      }
    }
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
        QuadRecord record;
        Bvh::LeafRoom room;
        make_quad_record(cones.whole.origin, tree.corners_of(item.child, room), item.child.count,
                         record);
        LaneMask there = (1u << item.child.count) - 1;
        if (record.unsure != 0) resolve_sides(item.child, record, there);
        LaneMask changed = 0;
        if (is_sparse(rays, groups, item.child.count)) {
          test_rays(walk, record, item.child, there, rays, changed);
        } else {
          test_groups<code()>(walk, record, item.child, there, rays, changed);
        }
        if (changed == 0) continue;
        for (; changed != 0; changed &= changed - 1) {
          const int g = std::countr_zero(changed);
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

  /// Decides exactly on which side of each triangle the origin lies where float32 is not sure. No
  /// ray hits a triangle whose plane contains the origin: such triangles are removed from `there`.
  void resolve_sides(const Bvh::Child& leaf, QuadRecord& record, LaneMask& there) const {
    for (LaneMask unsure = record.unsure; unsure != 0; unsure &= unsure - 1) {
      const int i = std::countr_zero(unsure);
      const int side =
          orient3d(origin_, bvh_.corners_of(leaf.first + static_cast<std::uint32_t>(i)));
      if (side == 0) {
        there &= ~(1u << i);
      } else {
        set_side(record, i, side);
      }
    }
  }

  /// Resolves a doubt of float32 about a ray and a primitive exactly. `sure` has bounds of t of a
  /// sure hit; it is null if the hit is not sure. Returns whether it is the nearest hit now.
  bool resolve(ConeTraversal& walk, int group, int lane, std::int32_t primitive,
               const Interval* sure) {
    const std::uint32_t number = walk.number(group, lane);
    const Ray& ray = rays_[number];
    NearestHit best, hit = {.primitive = static_cast<std::uint32_t>(primitive)};
    if (walk.primitive[group][lane] >= 0) {
      best.primitive = static_cast<std::uint32_t>(walk.primitive[group][lane]);
      best.t = walk.t(group, lane);
      counters_.hit.depth_doubts += sure != nullptr;
    }
    const float limit = query_.t_max_of(number);
    if (sure != nullptr) hit.t = *sure;
    if (!(sure != nullptr ? take_if_nearer(bvh_, ray, limit, hit, best, counters_)
                          : resolve_doubt(bvh_, ray, limit, hit, best, counters_))) {
      return false;
    }
    walk.low[group][lane] = std::bit_cast<std::int32_t>(float_below(best.t.low));
    walk.high[group][lane] = std::bit_cast<std::int32_t>(float_above(best.t.high));
    walk.primitive[group][lane] = primitive;
    return true;
  }

  /// Writes the nearest hits, with P if requested.
  void finish(const ConeTraversal& walk) {
    in_vectors([&](auto) RAYGATE_BODY {
      if (!query_.work.empty()) put_work(walk);
      std::uint64_t rays = 0;  // rays with a hit
      for (LaneMask groups = walk.cones.groups; groups != 0; groups &= groups - 1) {
        const int g = std::countr_zero(groups);
        rays |= std::uint64_t{0xFF & ~sign_mask(walk.primitive[g])} << (8 * g);
      }
      if (query_.with_points()) {
        put_with_points(walk, rays);
      } else {
        put(walk, rays);
      }
    });
  }

  void put_work(const ConeTraversal& walk) {
    for (int g = 0; g < ConeTraversal::kGroups; ++g) {
      for (LaneMask lanes = walk.started[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        query_.work[walk.number(g, lane)] = walk.work[g][lane];
      }
    }
  }

  RAYGATE_INLINE void put(const ConeTraversal& walk, std::uint64_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const int ray = std::countr_zero(rays), g = ray / kLanes, lane = ray % kLanes;
      hits_[walk.number(g, lane)] = {
          .primitive = static_cast<std::uint32_t>(walk.primitive[g][lane]), .t = walk.t(g, lane)};
    }
  }

  /// Collects the planes that these rays hit, mostly without duplicates.
  RAYGATE_INLINE void find_planes(const ConeTraversal& walk, std::uint64_t rays,
                                  SeenPlanes& planes) const {
    std::uint8_t last[SeenPlanes::kMost] = {};  // by hash: the last plane of a primitive
    const auto number_of = [&](std::int32_t hit) __attribute__((always_inline)) {
      const auto primitive = static_cast<std::uint32_t>(hit);
      std::uint8_t& number = last[primitive % SeenPlanes::kMost];
      // Branchless, as a branch would be unpredictable.
      const int known =
          (number < planes.count ? 1 : 0) & (planes.primitives[number] == primitive ? 1 : 0);
      number = static_cast<std::uint8_t>(known != 0 ? number : planes.count);
      planes.primitives[planes.count] = primitive;
      planes.count += 1 - known;
      return number;
    };
    for (LaneMask groups = groups_of(rays); groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      const IntLanes& hits = walk.primitive[g];
      std::uint8_t(&of)[kLanes] = planes.of_rays[g];
      if (sign_mask(hits == hits[0]) == 0xFF) {
        planes.even |= 1u << g;
        of[0] = number_of(hits[0]);
        continue;
      }
      for (LaneMask lanes = rays_of(rays, g); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        of[lane] = number_of(hits[lane]);
      }
    }
    for (int first = 0; first < planes.count; first += kPlanes) {
      PlaneViews views;
      for (int i = 0; i < kPlanes; ++i) {
        views.origins[i] = origin_;
        views.triangles[i] =
            bvh_.corners_of(planes.primitives[std::min(first + i, planes.count - 1)]);
      }
      Planes four;
      make_planes(views, four);
      IntQuad largest = {};
      for (int k = 0; k < 4; ++k) {
        const auto words = load<FloatQuad>(four.words[k]);
        std::memcpy(&planes.words[k][first], &words, sizeof words);
        if (k < 3) largest = maximum(largest, bits_in(words) >> 23 & 0xFF);
      }
      std::memcpy(&planes.largest[first], &largest, sizeof largest);
    }
  }

  /// Writes hits with P, which has the bits of plane_point.
  RAYGATE_INLINE void put_with_points(const ConeTraversal& walk, std::uint64_t rays) {
    SeenPlanes planes;
    find_planes(walk, rays, planes);
    counters_.hit.plane_tests += static_cast<std::uint64_t>(std::popcount(rays));
    for (LaneMask groups = groups_of(rays); groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      const FloatLanes n[3] = {planes.get(planes.words[0], g), planes.get(planes.words[1], g),
                               planes.get(planes.words[2], g)};
      const auto& from = walk.block->direction;
      FloatLanes point[3];
      IntLanes error_bits;
      plane_points(n, planes.get(planes.words[3], g), planes.get(planes.largest, g),
                   {from[0][g], from[1][g], from[2][g]}, point, error_bits);
      // The words to be written for each ray.
      const FloatLanes error = float_of(error_bits), primitive = float_of(walk.primitive[g]);
      FloatQuad rows[2][kQuad] = {
          {low_half(primitive), low_half(point[0]), low_half(point[1]), low_half(point[2])},
          {high_half(primitive), high_half(point[0]), high_half(point[1]), high_half(point[2])}};
      transpose(rows[0]);
      transpose(rows[1]);
      const FloatLanes low = float_of(walk.low[g]), high = float_of(walk.high[g]);
      Vec<double, 2> t[kLanes];
      pair_up(wide(low_half(low)), wide(low_half(high)), t);
      pair_up(wide(high_half(low)), wide(high_half(high)), t + kQuad);
      NearestHit* const hits = &hits_[walk.number(g, 0)];
      const auto write = [&](int lane) __attribute__((always_inline)) {
        static_assert(offsetof(NearestHit, primitive) == 0 && offsetof(NearestHit, point) == 4);
        std::memcpy(static_cast<void*>(&hits[lane]), &rows[lane / kQuad][lane % kQuad], 16);
        hits[lane].point_error = error[lane];
        std::memcpy(&hits[lane].t, &t[lane], sizeof t[lane]);
      };
      LaneMask lanes = rays_of(rays, g);
      if (lanes == 0xFF) {
        for (int lane = 0; lane < kLanes; ++lane) write(lane);
      } else {
        for (; lanes != 0; lanes &= lanes - 1) write(std::countr_zero(lanes));
      }
    }
  }

  const Bvh& bvh_;
  IntersectCounters& counters_;
  const glm::vec3 origin_;
  const std::span<const Ray> rays_;
  const RayQuery query_;
  const std::span<NearestHit> hits_;
};

}  // namespace

void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters) {
  PacketIntersector(bvh, rays, query, hits, counters).trace();
}

}  // namespace raygate
