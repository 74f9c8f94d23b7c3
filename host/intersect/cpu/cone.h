// Ray packet: up to 64 rays of one origin, and bounding cones around groups of eight.
#pragma once

#include <cstdint>
#include <span>

#include "host/base/lanes.h"
#include "host/bvh/packet_traversal.h"
#include "host/exact/exact.h"

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

}  // namespace raygate
