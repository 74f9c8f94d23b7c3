#include "sim/fp/vectors.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace raygate {

std::vector<OperandPair> crossed_edges(FloatFormat format) {
  const int max = format.max_field();
  const int bias = format.bias();
  const int f = format.frac_bits;
  std::set<int> fields;
  for (const int centre : {0, max, bias, bias - f, bias + f, f, 2 * f, max - f}) {
    for (int field = centre - 2; field <= centre + 2; ++field) {
      fields.insert(std::clamp(field, 0, max));
    }
  }
  const std::uint32_t all = format.frac_mask();
  const std::set<std::uint32_t> fractions = {0,       1,       2,           all,
                                             all - 1, all / 2, all / 2 + 1, all / 2 + 2};
  std::vector<std::uint32_t> edges;
  for (const int field : fields) {
    for (const std::uint32_t fraction : fractions) {
      const std::uint32_t bits = static_cast<std::uint32_t>(field) << f | fraction;
      edges.push_back(bits);
      edges.push_back(bits | format.sign_bit());
    }
  }
  std::vector<OperandPair> pairs;
  for (const std::uint32_t a : edges) {
    for (const std::uint32_t b : edges) pairs.push_back({a, b});
  }
  return pairs;
}

std::uint32_t PairSource::below(std::uint32_t n) {
  return static_cast<std::uint32_t>((engine_() >> 32) * n >> 32);
}

std::uint32_t PairSource::fraction() {
  const int width = format_.frac_bits;
  const std::uint32_t random = static_cast<std::uint32_t>(engine_()) & format_.frac_mask();
  const std::uint32_t ones = (1u << below(width + 1)) - 1;
  const std::uint32_t run = ones << below(width) & format_.frac_mask();
  switch (below(8)) {
    case 0:
      return run;
    case 1:
      return ~run & format_.frac_mask();
    case 2:
      return random & ~ones;  // zeros at the low end
    case 3:
      return random | (ones & format_.frac_mask());
    case 4:
      return (run + below(5) - 2) & format_.frac_mask();
    default:
      return random;
  }
}

std::uint32_t PairSource::number(int field) {
  const int clamped = std::clamp(field, 0, format_.max_field());
  return (below(2) != 0 ? format_.sign_bit() : 0) |
         static_cast<std::uint32_t>(clamped) << format_.frac_bits | fraction();
}

std::uint32_t PairSource::any() {
  switch (below(8)) {
    case 0:
      return number(static_cast<int>(below(3)));
    case 1:
      return number(format_.max_field() - static_cast<int>(below(3)));
    case 2:
      return number(format_.bias() + static_cast<int>(below(5)) - 2);
    default:
      return number(static_cast<int>(below(format_.max_field() + 1)));
  }
}

OperandPair PairSource::aligned() {
  const int reach = format_.frac_bits + 4;
  const std::uint32_t a = any();
  const int field = static_cast<int>(a >> format_.frac_bits) & format_.max_field();
  return {a, number(field + static_cast<int>(below(2 * reach + 1)) - reach)};
}

OperandPair PairSource::cancelling() {
  const std::uint32_t a = any();
  const std::uint32_t distance = below(4) == 0 ? 1u << format_.frac_bits : 0;  // next exponent
  const std::uint32_t sign = op_ == FloatOp::kAdd ? format_.sign_bit() : 0;
  const std::uint32_t b = (a ^ sign) + below(9) - 4 + distance;
  return below(2) != 0 ? OperandPair{a, b & format_.mask()} : OperandPair{b & format_.mask(), a};
}

OperandPair PairSource::near_boundary() {
  // Chooses a rounding boundary (a significand with one bit more than the format's) and an operand.
  // The other operand is the number that brings the result nearest to the boundary, or a neighbour.
  const int f = format_.frac_bits;
  const double boundary = std::ldexp(1.0 + std::ldexp(fraction() + 0.5 * below(2), -f), 0);
  const double other = 1.0 + std::ldexp(fraction(), -f);
  double wanted = op_ == FloatOp::kDiv ? boundary * other : boundary / other;
  const int exponent = std::ilogb(wanted);
  wanted = std::ldexp(wanted, -exponent) - 1.0;
  const std::uint32_t nearest = static_cast<std::uint32_t>(std::lrint(std::ldexp(wanted, f)));
  const std::uint32_t ulps = below(3) - 1;
  const int a_field = static_cast<int>(below(format_.max_field() + 1));
  const std::uint32_t keep = ~format_.frac_mask();
  const std::uint32_t a = (number(a_field) & keep) | ((nearest + ulps) & format_.frac_mask());
  const std::uint32_t b_bits = static_cast<std::uint32_t>(std::lrint(std::ldexp(other - 1.0, f)));
  return {a, (any() & keep) | b_bits};
}

OperandPair PairSource::near_range_end() {
  // Aims at an exponent field of the result: a product's is the sum of the fields less the bias.
  const int top =
      below(2) != 0 ? format_.max_field() : -static_cast<int>(below(format_.frac_bits + 3));
  const int result = top + static_cast<int>(below(5)) - 2;
  const int a = static_cast<int>(below(format_.max_field()));
  const int b = op_ == FloatOp::kDiv ? a - result + format_.bias() : result - a + format_.bias();
  return {number(a), number(b)};
}

namespace {

/// Returns significands {a, b} whose quotient is very close to a rounding boundary m / 2^z, or
/// {0, 0} if there is none for this odd b and r. a and b are in [2^F, 2^(F+1)), F = frac_bits. k is
/// F+1, or F+2 for quotients below 1. For a boundary at a representable number, m has F+1 bits and
/// z = k - 1. For a boundary midway between two (`midpoint`), m has F+2 bits and z = k. If
/// a * 2^z = m * b + r, the distance from a / b to the boundary is r / (b * 2^z). Therefore
/// m = -r / b modulo 2^z, which gives m and then a (Matula and McFearin, 2001).
OperandPair hard_division(FloatFormat format, std::uint32_t b, int r, int k, bool midpoint) {
  const int f = format.frac_bits;
  std::uint64_t inverse = b;  // 1 / b modulo 2^64: each step doubles the number of correct bits
  for (int i = 0; i < 5; ++i) inverse *= 2 - b * inverse;
  const int zeros = midpoint ? k : k - 1;
  const int bits = midpoint ? f + 2 : f + 1;
  const std::uint64_t m =
      -static_cast<std::uint64_t>(r) * inverse & ((std::uint64_t{1} << zeros) - 1);
  for (std::uint64_t candidate = m; candidate < std::uint64_t{1} << bits;
       candidate += std::uint64_t{1} << zeros) {
    const std::uint64_t a = (candidate * b + r) >> zeros;
    if (candidate >> (bits - 1) == 1 && a >> f == 1) return {static_cast<std::uint32_t>(a), b};
  }
  return {};
}

}  // namespace

OperandPair PairSource::hard_quotient() {
  const int f = format_.frac_bits;
  for (int attempt = 0; attempt < 64; ++attempt) {
    const std::uint32_t b = 1u << f | fraction() | 1u;
    const int r = static_cast<int>(2 * below(3) + 1) * (below(2) != 0 ? 1 : -1);
    const OperandPair found =
        hard_division(format_, b, r, f + 1 + static_cast<int>(below(2)), below(2) != 0);
    if (found.a == 0) continue;
    const std::uint32_t keep = ~format_.frac_mask();
    return {(any() & keep) | (found.a & format_.frac_mask()),
            (any() & keep) | (found.b & format_.frac_mask())};
  }
  return {any(), any()};
}

OperandPair PairSource::next() {
  const bool sum = op_ == FloatOp::kAdd || op_ == FloatOp::kSub;
  switch (below(8)) {
    case 0:
      return {any(), any()};
    case 1:
      return aligned();
    case 2:
      return cancelling();
    case 3:
      return sum ? aligned() : near_range_end();
    case 4:
      return op_ == FloatOp::kDiv ? hard_quotient() : sum ? aligned() : near_boundary();
    case 5:
      return op_ == FloatOp::kDiv ? hard_quotient() : sum ? cancelling() : near_range_end();
    case 6:
      return sum ? aligned() : near_boundary();
    default:
      return {number(static_cast<int>(below(format_.max_field() + 1))),
              number(static_cast<int>(below(format_.max_field() + 1)))};
  }
}

}  // namespace raygate
