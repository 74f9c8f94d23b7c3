// IEEE 754 arithmetic, rounded to nearest: checking it, setting it, and the hardware's operations.
#pragma once

#include <bit>
#include <cfenv>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

// Reproducibility guarantees
//
// The same program with the same inputs writes the same bytes for any number of threads or lanes,
// any engine and any unit. On another machine or with another compiler, the following holds if
// this file compiles and require_ieee_floats() passes:
//   * every decision (hit or miss, order of hits, side) is the same, because it is exact;
//   * polygon records, hit distances, hit points and their error bounds have the same bits for any
//     instruction set: they use only IEEE 754 +, *, / in a fixed order;
//   * pixels of images have the same bits (see elementary.h), except for glTF files with rotated
//     textures or an orthographic camera: these use sines, cosines or atan of the C library.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "exact arithmetic: found -ffast-math or a part of it, expected IEEE 754 as it stands"
#endif
static_assert(FLT_EVAL_METHOD == 0, "exact arithmetic: expected floats to be computed as floats");
static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

namespace raygate {

/// Sets IEEE 754 arithmetic (rounding to nearest, subnormals kept, no traps) on this thread, and on
/// threads that it starts, until the destructor restores the thread's state, including flags.
class IeeeFloats {
 public:
  IeeeFloats();
  ~IeeeFloats();
  IeeeFloats(const IeeeFloats&) = delete;
  IeeeFloats& operator=(const IeeeFloats&) = delete;

 private:
#if defined(__SSE2__)
  // Of the x87 state, only the rounding mode is saved: the C library uses it to read numbers.
  // Saving all of the state would take a microsecond, and no arithmetic here uses x87.
  unsigned before_;  // MXCSR
  int rounding_;
#else
  std::fenv_t before_;
#endif
};

/// Throws std::runtime_error with one line if this thread's arithmetic differs: another rounding
/// mode, subnormals flushed to zero (a side effect of other code linked with -ffast-math), or fused
/// multiply-adds. Threads inherit the state of the thread that starts them, so one call is enough.
void require_ieee_floats();

/// The operations of the hardware's float cores, bit for bit. Requires the machine's default
/// floating-point environment (subnormals kept) and no fused multiply-adds.
struct Binary32 {
  /// Returns a number or vector unchanged, since this format holds every float.
  template <class T>
  static T read(const T& x) {
    return x;
  }
  static float add(float a, float b) { return canonical(a + b); }
  static float multiply(float a, float b) { return canonical(a * b); }
  static float divide(float a, float b) { return canonical(a / b); }
  /// Returns (ax bx + ay by) + az bz. NaN results are not used, and may differ from the hardware's.
  static float dot(const glm::vec3& a, const glm::vec3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
  }

  static std::uint32_t to_word(float x) { return std::bit_cast<std::uint32_t>(x); }
  static float from_word(std::uint32_t word) { return std::bit_cast<float>(word); }
  static int exponent_field(float x) { return static_cast<int>(to_word(x) >> 23 & 0xFF); }
  static bool is_normal(float x) { return exponent_field(x) != 0 && exponent_field(x) != 0xFF; }
  static constexpr int fraction_bits() { return 23; }

 private:
  /// Returns x, or the only NaN that the hardware produces if x is any NaN.
  static float canonical(float x) { return std::isnan(x) ? std::bit_cast<float>(0x7FC00000u) : x; }
};

}  // namespace raygate
