// Ray packet: up to 64 rays of one origin, and bounding cones around groups of eight.
#pragma once

#include <cstdint>
#include <span>

#include "host/base/lanes.h"
#include "host/bvh/packet_traversal.h"
#include "host/exact/exact.h"

namespace raygate {

/// The directions of up to 64 rays, ray k of group g being number 8 g + k of the block.
struct RayPacket {
  static constexpr int kGroups = 8, kRays = kGroups * kLanes;

  FloatLanes direction[3][kGroups];
  LaneMask negative[3][kGroups];  ///< whose component is below 0
  LaneMask usable[kGroups];       ///< see is_usable; no bits beyond the end of the rays
  std::uint32_t octants;          ///< bit i: usable rays may go into octant i; else none does

  [[nodiscard]] LaneMask into_octant(int octant, int group) const {
    LaneMask lanes = usable[group];
    for (int k = 0; k < 3; ++k) {
      lanes &= (octant >> k & 1) != 0 ? negative[k][group] : ~negative[k][group];
    }
    return lanes;
  }
};

/// Loads up to 64 rays. Bit k of the result is set where ray k is usable but not scaled.
[[nodiscard]] std::uint64_t load_packet(std::span<const Ray> rays, RayPacket& block);

/// Cones around rays of one octant, whatever the lengths of their directions. Lane g of a member
/// stands for group g; absent groups have a radius of 0. A ray I stands here as I / t_scale, where
/// its t_scale is one component's magnitude, the same one's for all, or 1 for all; its t becomes
/// t_scale t. On each axis |I_k / t_scale - center[k][g]| <= radius[k][g].
struct Cones {
  LaneMask active[RayPacket::kGroups];     ///< the rays of each group
  LaneMask groups;                         ///< the groups with any
  FloatLanes t_scale[RayPacket::kGroups];  ///< of each ray; an absent one's is 1
  FloatLanes center[3], radius[3];
  PacketBounds8 bounds8;  ///< cutoffs are left to the caller
  PacketBounds whole;     ///< around all groups
};

/// Cones around the block's rays in `cones.active`, which are of this octant. `cones.groups` is
/// found here, and so is all else.
void make_cones(const RayPacket& block, const glm::vec3& origin, int octant, Cones& cones);

}  // namespace raygate
