// Bit-exact model of reduced-precision hardware arithmetic.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// IEEE 754 rounding directions, with the codes of hw/fp/fp_pkg.sv.
enum class Rounding : std::uint8_t {
  kNearestEven = 0,
  kTowardZero = 1,
  kDown = 2,
  kUp = 3,
  kNearestAway = 4
};

/// A binary floating-point format no wider than binary32, and its operations. Numbers are held in
/// floats. Each operation rounds the exact result once, as in IEEE 754, except as the fields state.
/// Every NaN result is 0x7FC00000. Operands must be numbers of the format (see read).
struct Arithmetic {
  int digits = 24;        ///< significand bits, including the leading one: 3 to 24
  int exponent_bits = 8;  ///< 3 to 8
  Rounding rounding = Rounding::kNearestEven;
  bool flush = false;       ///< subnormal operands and results become zeros
  int quotient_digits = 0;  ///< if not 0: quotients are truncated to this many digits, not rounded
  bool fused = false;       ///< dot products are rounded once, at the end

  friend bool operator==(const Arithmetic&, const Arithmetic&) = default;

  /// Returns a float rounded to this format.
  [[nodiscard]] float read(float x) const { return fit(x, 0.0); }
  [[nodiscard]] glm::vec3 read(const glm::vec3& v) const {
    return {read(v.x), read(v.y), read(v.z)};
  }
  [[nodiscard]] float multiply(float a, float b) const;
  [[nodiscard]] float add(float a, float b) const;
  [[nodiscard]] float divide(float a, float b) const;
  /// Returns (ax bx + ay by) + az bz, rounded at each step or, if `fused`, once.
  [[nodiscard]] float dot(const glm::vec3& a, const glm::vec3& b) const;

  /// Returns the relative error bound of rounding to nearest: half the bound of other directions.
  [[nodiscard]] double unit_roundoff() const { return std::ldexp(1.0, -digits); }
  [[nodiscard]] int fraction_bits() const { return digits - 1; }
  /// Return the exponents of the smallest and the largest normal number.
  [[nodiscard]] int min_exponent() const { return 2 - (1 << (exponent_bits - 1)); }
  [[nodiscard]] int max_exponent() const { return (1 << (exponent_bits - 1)) - 1; }

  /// Returns whether the exponent field of x is neither 0 nor the largest.
  [[nodiscard]] bool is_normal(float x) const;
  /// Returns the biased exponent of x in this format.
  [[nodiscard]] int exponent_field(float x) const {
    return static_cast<int>(to_word(x) >> fraction_bits() & ((1u << exponent_bits) - 1));
  }

  /// Convert between a number and its encoding in this format: sign, biased exponent, fraction.
  [[nodiscard]] std::uint32_t to_word(float x) const;
  [[nodiscard]] float from_word(std::uint32_t word) const;
  [[nodiscard]] int word_bits() const { return exponent_bits + digits; }

 private:
  [[nodiscard]] float fit(double value, double rest) const;
};

}  // namespace raygate
