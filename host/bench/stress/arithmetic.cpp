#include "host/bench/stress/arithmetic.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace raygate::stress {

/// Rounds value + rest, `rest` being less than half an ulp of the double: the double is first made
/// odd where it is not exact (Boldo and Melquiond, "When double rounding is odd", 2005), so that
/// the second rounding sees on which side of every boundary the exact value lies.
float Arithmetic::fit(double value, double rest, int wanted_digits, bool cut) const {
  if (!std::isfinite(value) || value == 0.0) return static_cast<float>(value);
  if (rest != 0.0) {
    auto bits = std::bit_cast<std::uint64_t>(value);
    if ((rest > 0.0) != (value > 0.0)) --bits;
    value = std::bit_cast<double>(bits | 1);
  }
  const int exponent = std::max(std::ilogb(value), -126);
  const int quantum = exponent - wanted_digits + 1;
  const double scaled = std::ldexp(value, -quantum);
  const double rounded = std::ldexp(cut ? std::trunc(scaled) : std::nearbyint(scaled), quantum);
  if (std::abs(rounded) >= 0x1p128) {
    // The largest number of `digits` digits, or infinity.
    const double largest = std::ldexp(2.0 - std::ldexp(1.0, 1 - wanted_digits), 127);
    return static_cast<float>(
        std::copysign(cut ? largest : std::numeric_limits<double>::infinity(), value));
  }
  if (flush && std::abs(rounded) < 0x1p-126) {
    return static_cast<float>(std::copysign(0.0, value));
  }
  return static_cast<float>(rounded);
}

float Arithmetic::read(float x) const { return fit(x, 0.0, digits, truncate); }

float Arithmetic::multiply(float a, float b) const {
  return fit(static_cast<double>(a) * b, 0.0, digits, truncate);
}

float Arithmetic::add(float a, float b) const {
  const double x = a, y = b, sum = x + y;
  const double y_seen = sum - x;
  const double rest = std::isfinite(sum) ? (x - (sum - y_seen)) + (y - y_seen) : 0.0;
  return fit(sum, rest, digits, truncate);
}

float Arithmetic::divide(float a, float b) const {
  const double x = a, y = b, ratio = x / y;
  const double remainder = std::isfinite(ratio) ? std::fma(-ratio, y, x) : 0.0;
  const double rest = y < 0.0 ? -remainder : remainder;
  return quotient_digits != 0 ? fit(ratio, rest, quotient_digits, true)
                              : fit(ratio, rest, digits, truncate);
}

float Arithmetic::dot(const glm::vec3& a, const glm::vec3& b) const {
  return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z));
}

}  // namespace raygate::stress
