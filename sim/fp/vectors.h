// Operand pairs for the tests of the float cores: pairs of edge cases, then random ones.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "sim/fp/float_format.h"

namespace raygate {

struct OperandPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Returns all pairs of edge cases of both signs: zeros, infinities, quiet and signalling NaNs, and
/// numbers. Exponent fields are within 2 of 0, f, 2 f, bias - f, bias, bias + f, max - f or max,
/// with f = frac_bits. Fractions are near all zeros, near one half and near all ones.
std::vector<OperandPair> crossed_edges(FloatFormat format);

/// An endless random stream of pairs, with hard cases for `op`, from one seed.
class PairSource {
 public:
  PairSource(FloatFormat format, FloatOp op, std::uint64_t seed)
      : format_(format), op_(op), engine_(seed) {}

  OperandPair next();

 private:
  std::uint32_t below(std::uint32_t n);  // uniform in [0, n)
  std::uint32_t fraction();              // uniform, or runs of ones and zeros
  std::uint32_t any();                   // every class of number
  std::uint32_t number(int field);       // random sign and fraction; field is clamped
  OperandPair aligned();                 // exponents at most frac_bits + 4 apart
  OperandPair cancelling();              // terms that nearly cancel: a few units in the last place
  OperandPair near_boundary();           // product or quotient next to a rounding boundary
  OperandPair near_range_end();          // result at the edge of overflow or underflow
  OperandPair hard_quotient();           // quotient as close as possible to a rounding boundary

  FloatFormat format_;
  FloatOp op_;
  std::mt19937_64 engine_;
};

}  // namespace raygate
