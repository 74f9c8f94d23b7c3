// Operand pairs for the tests of the float cores: where such cores go wrong, then at random.
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

/// Every edge crossed with every edge: zeros, infinities, NaNs of both kinds, the exponents next to
/// the ends, to 1 and to the distances at which alignment changes, with fractions of no, one, all
/// but one and all bits, both signs.
std::vector<OperandPair> crossed_edges(FloatFormat format);

/// An endless stream of pairs aimed at `op`, from one seed.
class PairSource {
 public:
  PairSource(FloatFormat format, FloatOp op, std::uint64_t seed)
      : format_(format), op_(op), engine_(seed) {}

  OperandPair next();

 private:
  std::uint32_t below(std::uint32_t n);  // uniform in [0, n)
  std::uint32_t fraction();              // uniform, or runs of ones and zeros
  std::uint32_t any();                   // every class of number
  std::uint32_t number(int field);       // random sign and fraction; field put into range
  OperandPair aligned();                 // exponents as far apart as significands overlap
  OperandPair cancelling();              // magnitudes a few units apart, signs opposite
  OperandPair near_boundary();           // product or quotient next to a rounding boundary
  OperandPair near_range_end();          // result at the edge of overflow or underflow
  OperandPair hard_quotient();

  FloatFormat format_;
  FloatOp op_;
  std::mt19937_64 engine_;
};

/// A division whose quotient lies as close to a rounding boundary as one can: significands
/// a, b in [2^F, 2^(F+1)), F = frac_bits, with a * 2^k = m * b + r, |r| small, where m has
/// F+2 bits if it is odd (a midpoint: F+1 fraction bits) or is an even one (a representable
/// number). Given b odd and r, m is r / -b modulo a power of two (after Matula and McFearin,
/// "Generation and analysis of hard to round cases for binary floating point division", 2001). `k`
/// is F+1, or F+2 for quotients below 1. Returns {0, 0} where there is no such a.
OperandPair hard_division(FloatFormat format, std::uint32_t b, int r, int k, bool midpoint);

}  // namespace raygate
