// Checks for IEEE 754 arithmetic, each operation rounded to nearest, on which exactness rests.
#pragma once

#include <cfenv>
#include <cfloat>
#include <limits>

// What is promised across machines
//
// Same program, same inputs, any number of threads, any engine, unit and number of lanes: the same
// bytes. On another machine, or by another compiler, wherever this file compiles and its check
// passes:
//   * every decision (hit or miss, which is nearest, which side) is the same, as it is exact;
//   * polygon records, t, P and their errors have the same bits, as they come from IEEE 754's
//     addition, multiplication and division alone, in a fixed order, whatever vector code runs;
//   * pictures may differ in last digits where shading asks the C library for a power, a sine or a
//     cosine: IEEE 754 leaves those to it. With one version of it they do not.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "exact arithmetic: found -ffast-math or a part of it, expected IEEE 754 as it stands"
#endif
static_assert(FLT_EVAL_METHOD == 0, "exact arithmetic: expected floats to be computed as floats");
static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

namespace raygate {

/// IEEE 754's arithmetic on this thread for as long as this lives, and on threads that it starts
/// meanwhile: rounding to nearest, subnormals kept, no traps, whatever another library has set.
/// Then the thread's state is what it was, flags included.
class IeeeFloats {
 public:
  IeeeFloats();
  ~IeeeFloats();
  IeeeFloats(const IeeeFloats&) = delete;
  IeeeFloats& operator=(const IeeeFloats&) = delete;

 private:
#if defined(__SSE2__)
  // Of x87 the rounding mode, which decides how the C library reads numbers. Its other state would
  // cost a microsecond, and nothing here computes by it.
  unsigned before_;  // MXCSR
  int rounding_;
#else
  std::fenv_t before_;
#endif
};

/// Throws std::runtime_error, one line, where this thread's arithmetic is not that: another
/// rounding mode, subnormals flushed to zero (as programs linked with -ffast-math do to others), or
/// multiply and add fused. Threads inherit the state of the one that starts them: asking once is
/// enough.
void require_ieee_floats();

}  // namespace raygate
