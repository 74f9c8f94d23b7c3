// What IEEE 754 says an operation gives, from MPFR and integers; shares nothing with the hardware.
#pragma once

#include <cstdint>

#include "sim/fp/float_format.h"

namespace raygate {

/// The exact result of an operation, cut off towards zero to 64 bits or less:
/// (-1)^negative * (significand + something in [0, 1), above 0 if `inexact`) * 2^exponent.
struct ExactValue {
  enum class Kind { kFinite, kInfinity, kNan };
  Kind kind = Kind::kFinite;
  bool negative = false;
  bool exact_zero_sum = false;  // x - x: its sign depends on the rounding mode
  bool inexact = false;
  std::uint64_t significand = 0;
  int exponent = 0;
  std::uint8_t flags = 0;  // invalid, divide by zero: known before any rounding
};

/// a `op` b for an arithmetic op, before rounding.
ExactValue exact_result(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b);

/// Rounds to the format. IEEE 754-2019, clauses 4.3 and 7.
FloatResult round_exact(FloatFormat format, const ExactValue& value, RoundingMode rounding,
                        Tininess tininess);

/// a `op` b for a comparison.
FloatResult oracle_compare(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b);

}  // namespace raygate
