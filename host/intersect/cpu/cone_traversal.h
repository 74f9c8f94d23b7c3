// Traversal state of a packet of up to 64 rays.
#pragma once

#include <bit>
#include <cstdint>

#include "host/bvh/bvh_view.h"
#include "host/exact/exact.h"
#include "host/intersect/cpu/cone.h"
#include "host/intersect/intersector.h"

namespace raygate {

// Sets of a block's 64 rays: byte g holds the rays of group g.

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

/// Distances (t) are the bits of floats: positive floats are in the order of their bits.
struct ConeTraversal {
  static constexpr int kGroups = RayPacket::kGroups;

  /// What of the tree waits to be visited: the nearest last, as far as one node knows.
  struct StackEntry {
    Bvh::Child child;
    float entry;
    std::uint64_t rays;  ///< those that may meet it
  };

  const RayPacket* block;
  std::uint32_t first;  ///< the number of the block's first ray
  Cones cones;
  PacketBounds8 ray_bounds8[kGroups];    ///< around each ray, where a group has been split
  LaneMask split;                        ///< the groups that have been
  IntLanes low[kGroups], high[kGroups];  ///< of each ray: bounds of the nearest hit's t
  IntLanes primitive[kGroups];           ///< of the nearest hit; -1: none
  IntLanes skip_id[kGroups];             ///< a primitive; -1: none
  IntLanes enough[kGroups];              ///< a hit that is surely before is enough
  FloatLanes slack;  ///< lane g: how many times an edge's bound all of group g may be off it
  // If that is asked for: what each ray's query took, and which rays there are.
  RayWork work[kGroups][kLanes];
  LaneMask started[kGroups];
  std::uint64_t going;  ///< the rays that still look for something
  float cutoff;         ///< boxes beyond matter to none
  int depth;            ///< of the stack
  StackEntry stack[Bvh::kStackSize];

  [[nodiscard]] std::uint32_t number(int group, int lane) const {
    return first + static_cast<std::uint32_t>(group * kLanes + lane);
  }
  /// Bounds of the nearest hit's t.
  [[nodiscard]] Interval t(int group, int lane) const {
    return {std::bit_cast<float>(low[group][lane]), std::bit_cast<float>(high[group][lane])};
  }
};

/// Where boxes end to matter for rays of these t_scales that end at `high` (see cutoff_beyond).
RAYGATE_INLINE void cutoffs_beyond(const IntLanes& high, const FloatLanes& t_scale, LaneMask active,
                                   FloatLanes& cutoffs) {
  constexpr float kGrow = 1.0f + 0x1p-20f;
  const IntLanes going = lanes_of(active);
  cutoffs = going ? reinterpret_cast<FloatLanes>(high) * t_scale * kGrow : FloatLanes{} - 1.0f;
}

/// Looks no farther than `high` and `cones.active` say, for the rays of a group.
RAYGATE_INLINE void shorten(ConeTraversal& walk, int group) {
  Cones& cones = walk.cones;
  FloatLanes cutoffs;
  cutoffs_beyond(walk.high[group], cones.t_scale[group], cones.active[group], cutoffs);
  cones.bounds8.cutoff[group] = largest_of(cutoffs);
  if ((walk.split >> group & 1) != 0) walk.ray_bounds8[group].cutoff = cutoffs;
  walk.going &= ~(std::uint64_t{0xFF & ~cones.active[group]} << (8 * group));
}

}  // namespace raygate
