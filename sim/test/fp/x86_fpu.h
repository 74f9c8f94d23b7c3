// The SSE unit of an x86 as a second opinion on binary32: four rounding modes, tininess detected
// after rounding. On other machines x86_has() is false and nothing is asked.
#pragma once

#include <bit>
#include <cstdint>

#include "sim/fp/float_format.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace raygate {

#if defined(__SSE2__)

constexpr bool x86_has(RoundingMode rounding) {
  return rounding != RoundingMode::kNearestMaxMagnitude;
}

/// a `op` b, an arithmetic op. A NaN comes back as the cores' own, for x86 keeps payloads.
inline FloatResult x86_result(FloatOp op, std::uint32_t a, std::uint32_t b, RoundingMode rounding) {
  constexpr unsigned kModes[] = {_MM_ROUND_NEAREST, _MM_ROUND_TOWARD_ZERO, _MM_ROUND_DOWN,
                                 _MM_ROUND_UP};
  const unsigned saved = _mm_getcsr();
  _mm_setcsr(_MM_MASK_MASK | kModes[static_cast<int>(rounding)]);
  // Volatile keeps the operation between the two changes of the control register.
  volatile float x = std::bit_cast<float>(a);
  volatile float y = std::bit_cast<float>(b);
  volatile float z;
  switch (op) {
    case FloatOp::kAdd:
      z = x + y;
      break;
    case FloatOp::kSub:
      z = x - y;
      break;
    case FloatOp::kMul:
      z = x * y;
      break;
    default:
      z = x / y;
      break;
  }
  const unsigned status = _mm_getcsr();
  _mm_setcsr(saved);
  FloatResult out{std::bit_cast<std::uint32_t>(static_cast<float>(z)), 0};
  if (kBinary32.is_nan(out.bits)) out.bits = kBinary32.quiet_nan();
  if ((status & _MM_EXCEPT_INVALID) != 0) out.flags |= kInvalid;
  if ((status & _MM_EXCEPT_DIV_ZERO) != 0) out.flags |= kDivideByZero;
  if ((status & _MM_EXCEPT_OVERFLOW) != 0) out.flags |= kOverflow;
  if ((status & _MM_EXCEPT_UNDERFLOW) != 0) out.flags |= kUnderflow;
  if ((status & _MM_EXCEPT_INEXACT) != 0) out.flags |= kInexact;
  return out;
}

#else

constexpr bool x86_has(RoundingMode) { return false; }
inline FloatResult x86_result(FloatOp, std::uint32_t, std::uint32_t, RoundingMode) { return {}; }

#endif

}  // namespace raygate
