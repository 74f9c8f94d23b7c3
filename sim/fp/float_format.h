// Floating-point formats, operations and results of the float cores.
#pragma once

#include <cstdint>

namespace raygate {

/// A format encoded like IEEE 754's interchange formats: sign, `exp_bits` of biased exponent,
/// `frac_bits` of fraction; at most 32 bits in all.
struct FloatFormat {
  int exp_bits;
  int frac_bits;

  constexpr int width() const { return 1 + exp_bits + frac_bits; }
  constexpr int bias() const { return (1 << (exp_bits - 1)) - 1; }
  constexpr int max_field() const { return (1 << exp_bits) - 1; }
  constexpr std::uint32_t sign_bit() const { return 1u << (exp_bits + frac_bits); }
  constexpr std::uint32_t frac_mask() const { return (1u << frac_bits) - 1; }
  constexpr std::uint32_t mask() const { return 2 * sign_bit() - 1; }
  constexpr std::uint32_t infinity() const {
    return static_cast<std::uint32_t>(max_field()) << frac_bits;
  }
  /// The canonical NaN, the only NaN that the cores return.
  constexpr std::uint32_t quiet_nan() const { return infinity() | 1u << (frac_bits - 1); }
  /// Returns whether `bits` (at most width() bits) are a quiet or signalling NaN.
  constexpr bool is_nan(std::uint32_t bits) const { return (bits & ~sign_bit()) > infinity(); }
  constexpr bool is_signaling(std::uint32_t bits) const {
    return is_nan(bits) && (bits >> (frac_bits - 1) & 1) == 0;
  }

  friend constexpr bool operator==(const FloatFormat&, const FloatFormat&) = default;
};

inline constexpr FloatFormat kBinary32{8, 23};
inline constexpr FloatFormat kBinary16{5, 10};
inline constexpr FloatFormat kBfloat16{8, 7};
inline constexpr FloatFormat kFloat8{4, 3};  // IEEE semantics: infinities, several NaNs

enum class FloatOp { kAdd, kSub, kMul, kDiv, kEq, kLt, kLe };

/// Rounding modes, encoded as in fp_pkg::rounding_mode_e.
enum class RoundingMode : std::uint8_t {
  kNearestEven = 0,
  kTowardZero = 1,
  kDown = 2,
  kUp = 3,
  kNearestMaxMagnitude = 4
};

/// Returns the mode of rounding_mode_i = `encoding` (0 to 7): 5 to 7, reserved, round towards zero.
constexpr RoundingMode rounding_of(int encoding) {
  return encoding <= 4 ? static_cast<RoundingMode>(encoding) : RoundingMode::kTowardZero;
}

enum class Tininess : std::uint8_t { kBeforeRounding = 0, kAfterRounding = 1 };

/// Bits of a set of exception flags, as in RISC-V, TestFloat and fp_pkg::flags_t.
inline constexpr std::uint8_t kInexact = 1;
inline constexpr std::uint8_t kUnderflow = 2;
inline constexpr std::uint8_t kOverflow = 4;
inline constexpr std::uint8_t kDivideByZero = 8;
inline constexpr std::uint8_t kInvalid = 16;

/// Result of one operation: the packed number, or 0 or 1 for a comparison, and its flags.
struct FloatResult {
  std::uint32_t bits = 0;
  std::uint8_t flags = 0;

  friend bool operator==(const FloatResult&, const FloatResult&) = default;
};

constexpr bool is_comparison(FloatOp op) { return op >= FloatOp::kEq; }

}  // namespace raygate
