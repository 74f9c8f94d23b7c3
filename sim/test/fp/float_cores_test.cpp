// Compares every operation of the float cores, in every format and mode, with the oracle. `make
// prove` proves the structural cores for all operands.
#include "sim/fp/float_cores.h"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "sim/fp/vectors.h"
#include "sim/test/fp/oracle.h"

namespace raygate {
namespace {

constexpr std::uint64_t kSeed = 20261128;

class FloatCoresTest : public testing::TestWithParam<std::tuple<FloatFormat, FloatOp>> {
 protected:
  /// Checks one pair in all five rounding modes and both kinds of tininess (a comparison: once).
  void pair(OperandPair operands) {
    const auto [a, b] = operands;
    const auto [format, op] = GetParam();
    const bool compares = is_comparison(op);
    const ExactValue exact = compares ? ExactValue{} : exact_result(format, op, a, b);
    for (int mode = 0; mode < (compares ? 1 : 10); ++mode) {
      const RoundingMode rounding = rounding_of(mode / 2);
      const auto tininess = static_cast<Tininess>(mode % 2);
      const FloatResult got = cores_->run(op, a, b, rounding, tininess);
      const FloatResult expected = compares ? oracle_compare(format, op, a, b)
                                            : round_exact(format, exact, rounding, tininess);
      ASSERT_EQ(got.bits, expected.bits) << std::hex << a << ' ' << b << " mode " << mode;
      ASSERT_EQ(got.flags, expected.flags) << std::hex << a << ' ' << b << " mode " << mode;
    }
  }

  std::unique_ptr<FloatCores> cores_ = rtl_float_cores(std::get<0>(GetParam()));
};

/// All pairs of the 8-bit format; crossed edges and 200,000 random pairs of the other formats.
TEST_P(FloatCoresTest, EqualTheOracle) {
  const auto [format, op] = GetParam();
  if (format == kFloat8) {
    for (std::uint32_t a = 0; a <= format.mask(); ++a) {
      for (std::uint32_t b = 0; b <= format.mask(); ++b) ASSERT_NO_FATAL_FAILURE(pair({a, b}));
    }
    return;
  }
  for (const OperandPair operands : crossed_edges(format)) ASSERT_NO_FATAL_FAILURE(pair(operands));
  PairSource source(format, op, kSeed);
  for (int i = 0; i < 200'000; ++i) ASSERT_NO_FATAL_FAILURE(pair(source.next()));
}

INSTANTIATE_TEST_SUITE_P(
    All, FloatCoresTest,
    testing::Combine(testing::Values(kBinary32, kBinary16, kBfloat16, kFloat8),
                     testing::Values(FloatOp::kAdd, FloatOp::kSub, FloatOp::kMul, FloatOp::kDiv,
                                     FloatOp::kEq, FloatOp::kLt, FloatOp::kLe)));

}  // namespace
}  // namespace raygate
