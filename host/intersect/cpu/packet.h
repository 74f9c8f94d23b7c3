// Ray packets: up to 64 rays of one origin, bounding cones around groups of eight, and the state of
// their traversal.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "host/base/lanes.h"
#include "host/bvh/traversal.h"
#include "host/exact/exact.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// The directions of up to 64 rays. Ray k of group g has index 8 g + k.
struct RayPacket {
  static constexpr int kGroups = 8, kRays = kGroups * kLanes;

  FloatLanes direction[3][kGroups];
  LaneMask negative[3][kGroups];  ///< rays with a negative component
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

/// Loads up to 64 rays. Returns a mask of the rays that are usable but not scaled.
[[nodiscard]] std::uint64_t load_packet(std::span<const Ray> rays, RayPacket& block);

/// Bounding cones of rays in one octant, independent of the lengths of directions. Lane g belongs
/// to group g; absent groups have radius 0. A ray I is represented by I / t_scale, where t_scale is
/// the magnitude of one component, the same for all rays, or 1 for all; t then becomes t_scale t.
/// On each axis |I_k / t_scale - center[k][g]| <= radius[k][g].
struct Cones {
  LaneMask active[RayPacket::kGroups];     ///< rays of each group
  LaneMask groups;                         ///< groups with any ray
  FloatLanes t_scale[RayPacket::kGroups];  ///< of each ray; 1 for absent rays
  FloatLanes center[3], radius[3];
  PacketBounds8 bounds8;  ///< the caller sets the cutoffs
  PacketBounds whole;     ///< bounds of all groups
};

/// Computes all members for the packet's rays in `cones.active`, which must be in this octant.
void make_cones(const RayPacket& block, const glm::vec3& origin, int octant, Cones& cones);

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

  /// A subtree to visit. The nearest one, as far as known from its parent, is on top of the stack.
  struct StackEntry {
    Bvh::Child child;
    float entry;
    std::uint64_t rays;  ///< rays that may meet it
  };

  const RayPacket* block;
  std::uint32_t first;  ///< index of the packet's first ray
  Cones cones;
  PacketBounds8 ray_bounds8[kGroups];    ///< bounds of each ray, for groups in `split`
  LaneMask split;                        ///< groups with valid ray_bounds8
  IntLanes low[kGroups], high[kGroups];  ///< of each ray: bounds of the nearest hit's t
  IntLanes primitive[kGroups];           ///< of the nearest hit; -1: none
  IntLanes skip_id[kGroups];             ///< a primitive; -1: none
  IntLanes enough[kGroups];              ///< a hit that is surely nearer than this ends the ray
  FloatLanes slack;  ///< lane g: the factor of edge bounds for group g (see packet_steps.h)
  // If requested: the work of each ray, and the rays that were started.
  RayWork work[kGroups][kLanes];
  LaneMask started[kGroups];
  std::uint64_t going;  ///< rays that continue
  float cutoff;         ///< boxes beyond this are skipped
  int depth;            ///< of the stack
  StackEntry stack[Bvh::kStackSize];

  [[nodiscard]] std::uint32_t number(int group, int lane) const {
    return first + static_cast<std::uint32_t>(group * kLanes + lane);
  }
  /// Returns bounds of the nearest hit's t.
  [[nodiscard]] Interval t(int group, int lane) const {
    return {std::bit_cast<float>(low[group][lane]), std::bit_cast<float>(high[group][lane])};
  }
};

/// Computes distances beyond which boxes can be skipped for rays with these t_scales and maximum
/// distances `high` (see cutoff_beyond).
RAYGATE_INLINE void cutoffs_beyond(const IntLanes& high, const FloatLanes& t_scale, LaneMask active,
                                   FloatLanes& cutoffs) {
  constexpr float kGrow = 1.0f + 0x1p-20f;
  const IntLanes going = lanes_of(active);
  cutoffs = going ? reinterpret_cast<FloatLanes>(high) * t_scale * kGrow : FloatLanes{} - 1.0f;
}

/// Updates the cutoffs of a group after changes of `high` and `cones.active`.
RAYGATE_INLINE void shorten(ConeTraversal& walk, int group) {
  Cones& cones = walk.cones;
  FloatLanes cutoffs;
  cutoffs_beyond(walk.high[group], cones.t_scale[group], cones.active[group], cutoffs);
  cones.bounds8.cutoff[group] = largest_of(cutoffs);
  if ((walk.split >> group & 1) != 0) walk.ray_bounds8[group].cutoff = cutoffs;
  walk.going &= ~(std::uint64_t{0xFF & ~cones.active[group]} << (8 * group));
}

/// Intersects rays of one origin as Intersector::intersect does, in packets, but always culls.
/// `hits` are initialised to misses.
void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters);

}  // namespace raygate
