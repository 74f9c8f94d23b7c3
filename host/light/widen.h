// Four floats as doubles.
#pragma once

#include "host/base/lanes.h"

namespace raygate {

/// GCC 12 makes four instructions of what is one.
template <Vectors kCode>
RAYGATE_INLINE void widen(const FloatQuad& from, DoubleQuad& to) {
#ifdef RAYGATE_AVX2
  if constexpr (kCode != Vectors::kBaseline) {
    to = __builtin_ia32_cvtps2pd256(from);
    return;
  }
#endif
  to = __builtin_convertvector(from, DoubleQuad);
}

}  // namespace raygate
