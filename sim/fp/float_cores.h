// Interface for one floating-point operation at a time, and the Verilated cores behind it.
#pragma once

#include <memory>

#include "sim/fp/float_format.h"

namespace raygate {

/// Runs operations of one format. Not thread-safe: each thread needs its own.
class FloatCores {
 public:
  virtual ~FloatCores() = default;

  [[nodiscard]] virtual FloatFormat format() const = 0;

  /// Returns a `op` b; bits of a and b above the format's width must be 0. Comparisons ignore the
  /// rounding mode and the tininess.
  virtual FloatResult run(FloatOp op, std::uint32_t a, std::uint32_t b, RoundingMode rounding,
                          Tininess tininess) = 0;
};

/// Makes fp_multiplier, fp_adder, fp_divider and fp_compare, Verilated, for kBinary32, kBinary16,
/// kBfloat16 or kFloat8. Returns null for another format.
std::unique_ptr<FloatCores> rtl_float_cores(FloatFormat format);

}  // namespace raygate
