#include <bit>

#include "Vfp_divider_f32_cut.h"
#include "sim/model.h"
#include "sim/test/fp/format_test.h"

namespace raygate {
namespace {

using FpDivider = FormatTest;

TEST_P(FpDivider, Div) { run(FloatOp::kDiv); }

INSTANTIATE_TEST_SUITE_P(Formats, FpDivider, kAllFormats, format_name);

// All significands: every entry of the digit selection, under every divisor interval.
TEST(FpDivider, AllSignificandsOfBinary16) {
  const auto cores = rtl_float_cores(kBinary16);
  CoreCheck check(*cores, FloatOp::kDiv);
  const std::uint32_t one = 0x3c00;
  for (std::uint32_t a = one; a < 2 * one - 0x3800; ++a) {
    for (std::uint32_t b = one; b < 2 * one - 0x3800; ++b) {
      check.pair({a, b}, RoundingMode::kNearestEven, Tininess::kAfterRounding);
    }
  }
  EXPECT_EQ(check.cases(), 1u << 20);
  EXPECT_EQ(check.differences(), 0u) << check.report();
}

// Every quotient of binary32 that misses the middle between two numbers by one unit of the
// remainder, the least there is: the hardest to round to nearest.
TEST(FpDivider, HardestQuotientsOfBinary32) {
  const auto cores = rtl_float_cores(kBinary32);
  CoreCheck check(*cores, FloatOp::kDiv);
  constexpr std::uint32_t kOne = 0x3f800000;  // exponent of 1.0
  for (std::uint32_t b = 0x800001; b < 0x1000000; b += 2) {
    for (const int k : {24, 25}) {
      for (const int r : {-1, 1}) {
        const OperandPair hard = hard_division(kBinary32, b, r, k, true);
        if (hard.a == 0) continue;
        check.pair({kOne | (hard.a & 0x7fffff), kOne | (hard.b & 0x7fffff)},
                   RoundingMode::kNearestEven, Tininess::kAfterRounding);
      }
    }
  }
  EXPECT_GT(check.cases(), 5'800'000u);
  EXPECT_EQ(check.differences(), 0u) << check.report();
}

// The paper's worked example: d I / (I . H) with both kinds of divider.
TEST(FpDivider, QuotientsOfThePaper) {
  const auto cores = rtl_float_cores(kBinary32);
  Model<Vfp_divider_f32_cut> cut;
  const std::uint32_t divisor = 0x426ce740;
  const std::uint32_t cases[3][3] = {{0x40b98000, 0x3dc873fd, 0x3dc873f8},
                                     {0x41248000, 0x3e31c2a2, 0x3e31c2a0},
                                     {0x40a3a000, 0x3db0d093, 0x3db0d090}};
  for (const auto& [dividend, ieee, paper] : cases) {
    EXPECT_EQ(cores
                  ->run(FloatOp::kDiv, dividend, divisor, RoundingMode::kNearestEven,
                        Tininess::kAfterRounding)
                  .bits,
              ieee);
    cut->a_i = dividend;
    cut->b_i = divisor;
    cut.eval();
    EXPECT_EQ(cut->result_o, paper);
  }
}

// A cut-off quotient is the exact one with the bits after the 21st cleared: what the IEEE divider
// gives towards zero, less its last three bits, for normal results in every rounding mode.
TEST(FpDivider, CutOffIsTheExactQuotientCutOff) {
  const auto cores = rtl_float_cores(kBinary32);
  Model<Vfp_divider_f32_cut> cut;
  PairSource source(kBinary32, FloatOp::kDiv, test_seed());
  int normal = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto [a, b] = source.next();
    const FloatResult exact =
        cores->run(FloatOp::kDiv, a, b, RoundingMode::kTowardZero, Tininess::kAfterRounding);
    const std::uint32_t field = exact.bits >> 23 & 0xff;
    if (field == 0 || field == 0xff || (exact.flags & kOverflow) != 0) continue;
    ++normal;
    cut->a_i = a;
    cut->b_i = b;
    cut->rounding_mode_i = i % 5;
    cut.eval();
    ASSERT_EQ(cut->result_o, exact.bits & ~7u) << std::hex << a << " / " << b;
    ASSERT_EQ(cut->flags_o, 0) << std::hex << a << " / " << b;
  }
  EXPECT_GT(normal, 50'000);
}

}  // namespace
}  // namespace raygate
