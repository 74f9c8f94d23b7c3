// Float arithmetic as cheaper hardware would do it, bit for bit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// IEEE 754's rounding directions, numbered as hw/fp/fp_pkg.sv numbers them.
enum class Rounding : std::uint8_t {
  kNearestEven = 0,
  kTowardZero = 1,
  kDown = 2,
  kUp = 3,
  kNearestAway = 4
};

/// A binary format of at most float32's exponents and digits, whose numbers are held in floats, and
/// its operations. Each gives the exact result, rounded once, as IEEE 754 defines it but for what
/// the fields say; every NaN it gives is 0x7FC00000. Operands must be numbers of the format (see
/// read).
struct Arithmetic {
  int digits = 24;        ///< of a significand, the leading one counted: 3 to 24
  int exponent_bits = 8;  ///< 3 to 8
  Rounding rounding = Rounding::kNearestEven;
  bool flush = false;       ///< subnormals, read or made, are zeros
  int quotient_digits = 0;  ///< not 0: quotients are cut off after so many digits, not rounded
  bool fused = false;       ///< dot products are rounded once, at the end

  friend bool operator==(const Arithmetic&, const Arithmetic&) = default;

  /// A float taken into this format, rounded.
  [[nodiscard]] float read(float x) const;
  [[nodiscard]] glm::vec3 read(const glm::vec3& v) const {
    return {read(v.x), read(v.y), read(v.z)};
  }
  [[nodiscard]] float multiply(float a, float b) const;
  [[nodiscard]] float add(float a, float b) const;
  [[nodiscard]] float divide(float a, float b) const;
  /// (ax bx + ay by) + az bz, rounded at each step or once.
  [[nodiscard]] float dot(const glm::vec3& a, const glm::vec3& b) const;

  /// What rounding to nearest can be off by, relative to the result: half an ulp. Twice that for
  /// the other directions.
  [[nodiscard]] double unit_roundoff() const;
  [[nodiscard]] int fraction_bits() const { return digits - 1; }
  /// The exponents of the smallest and the largest normal numbers.
  [[nodiscard]] int min_exponent() const { return 2 - (1 << (exponent_bits - 1)); }
  [[nodiscard]] int max_exponent() const { return (1 << (exponent_bits - 1)) - 1; }

  /// Whether x has an exponent field that is neither 0 nor the largest.
  [[nodiscard]] bool is_normal(float x) const;
  /// The biased exponent of x's word.
  [[nodiscard]] int exponent_field(float x) const {
    return static_cast<int>(to_word(x) >> fraction_bits() & ((1u << exponent_bits) - 1));
  }

  /// The format's own bits of one of its numbers, and back: sign, biased exponent, fraction.
  [[nodiscard]] std::uint32_t to_word(float x) const;
  [[nodiscard]] float from_word(std::uint32_t word) const;
  [[nodiscard]] int word_bits() const { return exponent_bits + digits; }

 private:
  [[nodiscard]] float fit(double value, double rest) const;
};

}  // namespace raygate
