// Results of operations according to IEEE 754, from MPFR and integers; independent of the hardware.
#pragma once

#include <cstdint>

#include "sim/fp/float_format.h"

namespace raygate {

/// Exact result of an operation, truncated to 64 bits or less: (-1)^negative * (significand + f) *
/// 2^exponent, where f is in [0, 1), and not 0 if `inexact`.
struct ExactValue {
  enum class Kind { kFinite, kInfinity, kNan };
  Kind kind = Kind::kFinite;
  bool negative = false;
  bool exact_zero_sum = false;  // the result is x - x = 0; its sign depends on the rounding mode
  bool inexact = false;
  std::uint64_t significand = 0;
  int exponent = 0;
  std::uint8_t flags = 0;  // invalid, divide by zero: known before any rounding
};

/// Returns a `op` b for an arithmetic op, before rounding.
ExactValue exact_result(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b);

/// Rounds to the format, by IEEE 754-2019, clauses 4.3 and 7.
FloatResult round_exact(FloatFormat format, const ExactValue& value, RoundingMode rounding,
                        Tininess tininess);

/// Returns a `op` b for a comparison.
FloatResult oracle_compare(FloatFormat format, FloatOp op, std::uint32_t a, std::uint32_t b);

}  // namespace raygate
