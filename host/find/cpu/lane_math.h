// Small functions of eight lanes.
#pragma once

#include <cstdint>

#include "host/lanes.h"

namespace raygate {

/// -1 in the lanes of the mask, 0 in the others.
RAYGATE_INLINE void lanes_of(LaneMask mask, IntLanes& lanes) {
  constexpr IntLanes kBit = {1, 2, 4, 8, 16, 32, 64, 128};
  lanes = ((IntLanes{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
}

RAYGATE_INLINE void magnitude(const FloatLanes& x, FloatLanes& result) {
  result = reinterpret_cast<FloatLanes>(reinterpret_cast<IntLanes>(x) & 0x7FFFFFFF);
}

/// The largest lane; no NaN.
RAYGATE_INLINE float largest_of(const FloatLanes& lanes) {
  FloatLanes x = lanes, other = __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  x = x > other ? x : other;
  return x[0];
}

}  // namespace raygate
