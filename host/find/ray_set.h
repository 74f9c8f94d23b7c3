// Sets of a block's 64 rays: byte g holds the rays of group g.
#pragma once

#include <cstdint>

#include "host/lanes.h"

namespace raygate {

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

}  // namespace raygate
