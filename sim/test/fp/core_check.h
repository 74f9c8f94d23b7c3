// Drives a float core through operand pairs in all modes and holds it against the oracle.
#pragma once

#include <cstdint>
#include <string>

#include "sim/fp/float_cores.h"
#include "sim/fp/vectors.h"
#include "sim/test/fp/oracle.h"

namespace raygate {

/// Counts cases and differences; one case is one operation in one mode.
class CoreCheck {
 public:
  CoreCheck(FloatCores& cores, FloatOp op) : cores_(cores), format_(cores.format()), op_(op) {}

  /// One pair in all five rounding modes and both kinds of tininess (a comparison: once). In
  /// binary32 the machine's own FPU is asked as well, in its four rounding modes.
  void pair(OperandPair operands);

  /// One pair in one mode.
  void pair(OperandPair operands, RoundingMode rounding, Tininess tininess);

  /// Every pair of the format.
  void exhaustive();

  /// Every crossed edge, and `count` pairs of PairSource.
  void structured(std::uint64_t count, std::uint64_t seed);

  std::uint64_t cases() const { return cases_; }
  std::uint64_t differences() const { return differences_; }

  /// The first differences, as text.
  const std::string& report() const { return report_; }

 private:
  void check(OperandPair operands, const ExactValue& exact, RoundingMode rounding,
             Tininess tininess);
  void differ(OperandPair operands, RoundingMode rounding, Tininess tininess, FloatResult got,
              FloatResult expected, const char* whose);

  FloatCores& cores_;
  FloatFormat format_;
  FloatOp op_;
  std::uint64_t cases_ = 0;
  std::uint64_t differences_ = 0;
  std::string report_;
};

/// The seed of this run: RAYGATE_SEED from the environment, else 1. Printed once.
std::uint64_t test_seed();

}  // namespace raygate
