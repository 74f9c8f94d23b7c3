// IEEE 754 binary32, rounded to nearest even, in the machine's own float arithmetic.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// The operations of the hardware's float cores, bit for bit. Requires the machine's default
/// floating-point environment (subnormals kept) and no fused multiply-adds.
struct Binary32 {
  static float add(float a, float b) { return canonical(a + b); }
  static float multiply(float a, float b) { return canonical(a * b); }
  static float divide(float a, float b) { return canonical(a / b); }
  /// Returns (ax bx + ay by) + az bz. NaN results are not used, and may differ from the hardware's.
  static float dot(const glm::vec3& a, const glm::vec3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
  }

  static std::uint32_t to_word(float x) { return std::bit_cast<std::uint32_t>(x); }
  static int exponent_field(float x) { return static_cast<int>(to_word(x) >> 23 & 0xFF); }
  static bool is_normal(float x) { return exponent_field(x) != 0 && exponent_field(x) != 0xFF; }
  static constexpr int fraction_bits() { return 23; }

 private:
  /// Returns x, with the hardware's only NaN in place of any NaN.
  static float canonical(float x) { return std::isnan(x) ? std::bit_cast<float>(0x7FC00000u) : x; }
};

}  // namespace raygate
