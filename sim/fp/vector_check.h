// Test vectors in Berkeley TestFloat's text format, held against the float cores.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string_view>
#include <vector>

#include "sim/fp/float_cores.h"

namespace raygate {

/// An operation as TestFloat names it: f32_add ... f16_le.
struct VectorFunction {
  std::string_view name;
  FloatFormat format;
  FloatOp op;
};

/// All functions that have a core.
const std::vector<VectorFunction>& vector_functions();

struct VectorCheckOptions {
  FloatOp op = FloatOp::kAdd;
  RoundingMode rounding = RoundingMode::kNearestEven;
  Tininess tininess = Tininess::kAfterRounding;
  bool check_nans = false;       // else any NaN is as good as any other
  std::uint64_t max_shown = 20;  // differences printed
};

struct VectorCheckSummary {
  std::uint64_t vectors = 0;
  std::uint64_t differences = 0;
};

/// Runs every line of `in` (two operands, the result and the flags, all hexadecimal, between them
/// spaces; a comparison's result is 0 or 1) and prints what differs to `out`. A line that is
/// nothing of the kind is an InputError with its number, `name` standing for the file.
VectorCheckSummary check_vectors(std::istream& in, std::string_view name, FloatCores& cores,
                                 const VectorCheckOptions& options, std::ostream& out);

}  // namespace raygate
