// Checks for IEEE 754 arithmetic with rounding to nearest, which exactness requires.
#pragma once

#include <cfenv>
#include <cfloat>
#include <limits>

// Reproducibility guarantees
//
// The same program with the same inputs, and any number of threads, engine, unit and number of
// lanes, gives the same bytes. On another machine, or with another compiler, if this file compiles
// and its check passes:
//   * every decision (hit or miss, order of hits, side) is the same, as it is exact;
//   * polygon records, t, P and their errors have the same bits, as they use only IEEE 754
//     addition, multiplication and division, in a fixed order, with any vector code;
//   * images may differ in last digits where shading uses powers, sines or cosines of the C
//     library, which IEEE 754 does not define. With the same version of the library they do not.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "exact arithmetic: found -ffast-math or a part of it, expected IEEE 754 as it stands"
#endif
static_assert(FLT_EVAL_METHOD == 0, "exact arithmetic: expected floats to be computed as floats");
static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

namespace raygate {

/// Sets IEEE 754 arithmetic on this thread, and on threads that it starts, for the lifetime of this
/// object: rounding to nearest, subnormals kept, no traps. Then restores the thread's state,
/// including flags.
class IeeeFloats {
 public:
  IeeeFloats();
  ~IeeeFloats();
  IeeeFloats(const IeeeFloats&) = delete;
  IeeeFloats& operator=(const IeeeFloats&) = delete;

 private:
#if defined(__SSE2__)
  // Only the rounding mode of x87, which affects how the C library reads numbers. Saving its other
  // state would take a microsecond, and no arithmetic here uses it.
  unsigned before_;  // MXCSR
  int rounding_;
#else
  std::fenv_t before_;
#endif
};

/// Throws std::runtime_error, one line, if this thread's arithmetic differs: another rounding mode,
/// subnormals flushed to zero (a side effect of other code linked with -ffast-math), or fused
/// multiply-adds. Threads inherit the state of the thread that starts them, so one call is enough.
void require_ieee_floats();

}  // namespace raygate
