#include "host/variants/arithmetic.h"

#include <bit>
#include <limits>

#include "host/exact/expansion.h"

namespace raygate {
namespace {

constexpr int kDoubleDigits = 53;

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

float not_a_number() { return std::bit_cast<float>(0x7FC00000u); }

/// Returns `value` (not zero) rounded to a multiple of 2^quantum.
double rounded_to(double value, int quantum, Rounding rounding) {
  const double scaled = std::ldexp(value, -quantum);
  const double whole = rounding == Rounding::kNearestEven  ? std::nearbyint(scaled)
                       : rounding == Rounding::kTowardZero ? std::trunc(scaled)
                       : rounding == Rounding::kDown       ? std::floor(scaled)
                       : rounding == Rounding::kUp         ? std::ceil(scaled)
                                                           : std::round(scaled);
  return std::ldexp(whole, quantum);
}

/// Returns value + rest rounded to odd: sets the last bit if `rest` is not 0 (Boldo and Melquiond,
/// "When double rounding is odd", 2005). A second rounding is then correct. Only the sign of `rest`
/// matters: `value` is one of the two doubles next to the exact value.
double made_odd(double value, double rest) {
  if (rest == 0.0) return value;
  std::uint64_t bits = bits_of(value);
  if ((rest > 0.0) != (value > 0.0)) --bits;
  return std::bit_cast<double>(bits | 1);
}

}  // namespace

/// Rounds the exact value, which is `value` if `rest` is 0, and otherwise lies between `value` and
/// the next double in the direction of `rest`.
float Arithmetic::fit(double value, double rest) const {
  if (std::isnan(value)) return not_a_number();
  if (!std::isfinite(value) || value == 0.0) return static_cast<float>(value);
  value = made_odd(value, rest);
  const int exponent = static_cast<int>(bits_of(value) >> 52 & 0x7FF) - 1023;
  double rounded = 0.0;
  if (exponent >= min_exponent() && rounding == Rounding::kNearestEven) {
    // The excess digits are the low bits of the double. Add half of their unit, or slightly less if
    // the last digit kept is even. A carry correctly increments the exponent.
    const int dropped = kDoubleDigits - digits;
    const std::uint64_t bits = bits_of(value), unit = std::uint64_t{1} << dropped;
    rounded = std::bit_cast<double>((bits + (unit / 2 - 1) + (bits >> dropped & 1)) & ~(unit - 1));
  } else {
    rounded = rounded_to(value, std::max(exponent, min_exponent()) - digits + 1, rounding);
  }
  if (std::abs(rounded) >= std::ldexp(1.0, max_exponent() + 1)) {
    const bool away = rounding == (value < 0.0 ? Rounding::kDown : Rounding::kUp);
    const bool nearest = rounding == Rounding::kNearestEven || rounding == Rounding::kNearestAway;
    const double largest = std::ldexp(2.0 - std::ldexp(1.0, 1 - digits), max_exponent());
    rounded =
        std::copysign(nearest || away ? std::numeric_limits<double>::infinity() : largest, value);
  }
  if (rounded == 0.0 || (flush && std::abs(rounded) < std::ldexp(1.0, min_exponent()))) {
    rounded = std::copysign(0.0, value);
  }
  return static_cast<float>(rounded);
}

float Arithmetic::multiply(float a, float b) const { return fit(static_cast<double>(a) * b, 0.0); }

float Arithmetic::add(float a, float b) const {
  const auto [sum, rest] = two_sum(a, b);
  // The exact zero sum of operands with different signs is -0 when rounding down.
  if (sum == 0.0 && rounding == Rounding::kDown &&
      (a != 0.0f || std::signbit(a) != std::signbit(b))) {
    return -0.0f;
  }
  return fit(sum, std::isfinite(sum) ? rest : 0.0);
}

float Arithmetic::divide(float a, float b) const {
  const double x = a, y = b, ratio = x / y;
  const double remainder = std::isfinite(ratio) ? std::fma(-ratio, y, x) : 0.0;
  const double rest = y < 0.0 ? -remainder : remainder;
  if (quotient_digits == 0 || !std::isfinite(ratio) || ratio == 0.0) return fit(ratio, rest);
  // Truncate first, regardless of the exponent. Only subnormals are then rounded again.
  const double odd = made_odd(ratio, rest);
  const std::uint64_t dropped = (std::uint64_t{1} << (kDoubleDigits - quotient_digits)) - 1;
  return fit(std::bit_cast<double>(bits_of(odd) & ~dropped), 0.0);
}

float Arithmetic::dot(const glm::vec3& a, const glm::vec3& b) const {
  if (!fused) return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z));
  // Products of floats are exact in double. Their sum is high + low + rest, where high is within
  // half an ulp of the sum, and low + rest has the sign of sum - high.
  const double x = static_cast<double>(a.x) * b.x, y = static_cast<double>(a.y) * b.y,
               z = static_cast<double>(a.z) * b.z;
  const auto [sum_1, error_1] = two_sum(x, y);
  const auto [sum_2, error_2] = two_sum(sum_1, z);
  if (!std::isfinite(sum_2)) return fit(sum_2, 0.0);
  const auto [errors, error_3] = two_sum(error_1, error_2);
  const auto [high, low] = two_sum(sum_2, errors);
  const auto [middle, rest] = two_sum(low, error_3);
  return fit(high, middle != 0.0 ? middle : rest);
}

bool Arithmetic::is_normal(float x) const {
  const double magnitude = std::abs(static_cast<double>(x));
  return magnitude >= std::ldexp(1.0, min_exponent()) && std::isfinite(magnitude);
}

std::uint32_t Arithmetic::to_word(float x) const {
  const std::uint32_t fraction_width = static_cast<std::uint32_t>(fraction_bits());
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t sign = bits >> 31 << (word_bits() - 1);
  const std::uint32_t top = ((1u << exponent_bits) - 1) << fraction_width;
  if (std::isnan(x)) return top | 1u << (fraction_width - 1);
  if (std::isinf(x)) return sign | top;
  const double magnitude = std::abs(static_cast<double>(x));
  if (magnitude < std::ldexp(1.0, min_exponent())) {
    return sign |
           static_cast<std::uint32_t>(std::ldexp(magnitude, fraction_bits() - min_exponent()));
  }
  const std::uint64_t wide = bits_of(magnitude) >> (kDoubleDigits - digits);
  const std::uint64_t bias = static_cast<std::uint64_t>(1023 - max_exponent()) << fraction_width;
  return sign | static_cast<std::uint32_t>(wide - bias);
}

float Arithmetic::from_word(std::uint32_t word) const {
  const std::uint32_t fraction = word & ((1u << fraction_bits()) - 1);
  const int field = static_cast<int>(word >> fraction_bits()) & ((1 << exponent_bits) - 1);
  const bool negative = word >> (word_bits() - 1) & 1;
  double magnitude = 0.0;
  if (field == (1 << exponent_bits) - 1) {
    if (fraction != 0) return not_a_number();
    magnitude = std::numeric_limits<double>::infinity();
  } else {
    const int exponent = field == 0 ? min_exponent() : field - max_exponent();
    const std::uint32_t significand = fraction | (field == 0 ? 0u : 1u << fraction_bits());
    magnitude = std::ldexp(significand, exponent - fraction_bits());
  }
  return static_cast<float>(negative ? -magnitude : magnitude);
}

}  // namespace raygate
