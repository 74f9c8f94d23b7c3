#include "host/exact/ieee_floats.h"

#include <cfenv>
#include <stdexcept>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace raygate {
namespace {

/// Returns whether the compiler fuses the operations of a * a - w, for a = 1 + h and w = 1 + 2 h.
/// The exact product w + h^2 does not fit the format: the difference is 0 if the product is rounded
/// and h^2 if it is fused. `volatile` prevents evaluation by the compiler.
template <class T>
bool is_fused(T h) {
  volatile T a = T(1) + h, whole = T(1) + T(2) * h;
  return a * a - whole != T(0);
}

/// Returns whether subnormals are kept, by computing half the smallest normal number.
template <class T>
bool keeps_subnormals() {
  volatile T smallest = std::numeric_limits<T>::min();
  volatile T half = smallest * T(0.5);
  volatile T back = half + half;
  return half != T(0) && back == smallest;
}

}  // namespace

// These functions are not inline, so that compilers do not move arithmetic across calls.
#if defined(__SSE2__)
IeeeFloats::IeeeFloats() : before_(_mm_getcsr()), rounding_(std::fegetround()) {
  if (rounding_ != FE_TONEAREST) std::fesetround(FE_TONEAREST);
  constexpr unsigned kDefault = 0x1F80;  // value after reset, by the processor's manual
  _mm_setcsr(kDefault);
}
IeeeFloats::~IeeeFloats() {
  if (rounding_ != FE_TONEAREST) std::fesetround(rounding_);
  _mm_setcsr(before_);
}
#else
IeeeFloats::IeeeFloats() {
  std::fegetenv(&before_);
  std::fesetenv(FE_DFL_ENV);
}
IeeeFloats::~IeeeFloats() { std::fesetenv(&before_); }
#endif

void require_ieee_floats() {
  if (std::fegetround() != FE_TONEAREST) {
    throw std::runtime_error("arithmetic: found another rounding mode, expected to nearest");
  }
  if (!keeps_subnormals<float>() || !keeps_subnormals<double>()) {
    throw std::runtime_error("arithmetic: found subnormals flushed to zero, expected them kept");
  }
  if (is_fused(0x1p-12f) || is_fused(0x1p-27)) {
    throw std::runtime_error(
        "arithmetic: found multiply and add fused, expected -ffp-contract=off");
  }
}

}  // namespace raygate
