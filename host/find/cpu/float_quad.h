// Four floats at a time: one SSE register, for the triangles of a leaf.
#pragma once

#include <cstdint>
#include <cstring>

#include "host/lanes.h"

namespace raygate {

inline constexpr int kQuad = 4;
using FloatQuad = float __attribute__((vector_size(4 * kQuad), aligned(4 * kQuad)));
using IntQuad = std::int32_t __attribute__((vector_size(4 * kQuad), aligned(4 * kQuad)));

RAYGATE_INLINE void load_quad(const float* from, FloatQuad& to) {
  std::memcpy(&to, from, sizeof to);
}

RAYGATE_INLINE void magnitude(const FloatQuad& x, FloatQuad& result) {
  result = reinterpret_cast<FloatQuad>(reinterpret_cast<IntQuad>(x) & 0x7FFFFFFF);
}

/// The elements whose sign bit is set.
RAYGATE_INLINE LaneMask sign_mask(const IntQuad& quad) {
#if defined(__SSE__)
  return static_cast<LaneMask>(_mm_movemask_ps(reinterpret_cast<__m128>(quad)));
#else
  LaneMask mask = 0;
  for (int i = 0; i < kQuad; ++i) mask |= static_cast<LaneMask>(quad[i] < 0) << i;
  return mask;
#endif
}

}  // namespace raygate
