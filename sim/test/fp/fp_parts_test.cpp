// fp_unpack and fp_normalize against the fields of a float; fp_round against the oracle's rounding,
// for every exponent, in all modes, reserved ones too, and what overrides what.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "Vfp_parts_top.h"
#include "sim/model.h"
#include "sim/test/fp/oracle.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20260204;
constexpr FloatFormat kFormat = kBinary32;

TEST(FpPartsTest, UnpackedAndNormalized) {
  Model<Vfp_parts_top> model;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 300'000; ++i) {
    std::uint32_t word = random();
    if (i % 3 == 0) word &= 0x807fffff >> random() % 24;  // subnormals of every length
    if (i % 3 == 1) word = (word & 0x80000001) | (random() % 2 * 0x7f800000u);  // zeros, infinities
    model->packed_i = word;
    model.eval();
    const float value = std::bit_cast<float>(word);
    const std::uint32_t field = word >> 23 & 0xff,
                        significand = (word & 0x7fffff) | (field != 0 ? 0x800000u : 0u);
    ASSERT_EQ(model->sign_o, std::signbit(value));
    ASSERT_EQ(model->exponent_o, std::max(field, 1u)) << std::hex << word;
    ASSERT_EQ(model->significand_o, significand) << std::hex << word;
    const bool nan = std::isnan(value), infinity = std::isinf(value), zero = value == 0.0f;
    ASSERT_EQ(model->class_o, (nan || infinity || zero) << 4 | zero << 3 | infinity << 2 |
                                  nan << 1 | kFormat.is_signaling(word))
        << std::hex << word;
    if (significand == 0) continue;
    ASSERT_EQ(model->count_o, std::countl_zero(significand) - 8) << std::hex << word;
    ASSERT_EQ(model->normal_o, significand << model->count_o) << std::hex << word;
  }
}

class FpRoundTest : public testing::Test {
 protected:
  void set(bool sign, int exponent, std::uint32_t significand, int mode) {
    model_->round_sign_i = sign;
    model_->round_exponent_i = static_cast<std::uint16_t>(exponent) & 0x3ff;
    model_->round_significand_i = significand;
    model_->rounding_mode_i = static_cast<std::uint8_t>(mode / 2);
    model_->tininess_after_i = mode % 2;
    model_.eval();
  }

  Model<Vfp_parts_top> model_;
  std::mt19937 random_{kSeed};
};

TEST_F(FpRoundTest, RoundsAsTheOracleDoes) {
  model_->specials_i = 0;
  for (int exponent = -60; exponent < 280; ++exponent) {
    for (int i = 0; i < 60; ++i) {
      // [1, 4), ones and zeros where roundings change; below 1 too where the exponent is the
      // smallest.
      std::uint32_t significand = (random_() & 0xfffffff) | 0x4000000;
      if (i % 4 == 1) significand |= (1u << random_() % 28) - 1;
      if (i % 4 == 2) significand &= ~((1u << random_() % 26) - 1) | 0x4000000;
      if (exponent == 0 && i % 2 == 0) significand = (significand & 0x3fffffe) >> random_() % 20;
      const bool sign = random_() % 2 != 0, small = significand < 0x4000000;
      ExactValue exact;
      exact.negative = sign;
      exact.inexact = (significand & 1) != 0;
      exact.significand = std::uint64_t{significand >> 1} << 20;
      exact.exponent = exponent - kFormat.bias() - kFormat.frac_bits - 1 - 20;
      if (exact.inexact && small) continue;  // the sticky bit counts below a leading one alone
      // The sticky bit stands for something below the last place, which is now 20 places down.
      if (exact.inexact) exact.significand |= 1;
      for (int mode = 0; mode < 16; ++mode) {
        set(sign, exponent, significand, mode);
        const FloatResult expected =
            round_exact(kFormat, exact, rounding_of(mode / 2),
                        mode % 2 != 0 ? Tininess::kAfterRounding : Tininess::kBeforeRounding);
        for (int kind = 0; kind < 2; ++kind) {
          const auto where = [&] {
            return testing::Message() << "kind " << kind << " mode " << mode << " exponent "
                                      << exponent << std::hex << " significand " << significand;
          };
          if (!small) {
            ASSERT_EQ(model_->rounded_o >> 32 * kind & 0xffffffff, expected.bits) << where();
            ASSERT_EQ(model_->flags_o >> 5 * kind & 31, expected.flags) << where();
          }
          if (exponent < 0) continue;
          ASSERT_EQ(model_->in_place_o >> 32 * kind & 0xffffffff, expected.bits) << where();
          ASSERT_EQ(model_->in_place_flags_o >> 5 * kind & 31, expected.flags) << where();
        }
      }
    }
  }
}

TEST_F(FpRoundTest, SpecialsOverrideOneAnotherAndSilenceTheRest) {
  for (int specials = 4; specials < 32; ++specials) {  // at least one of NaN, infinity, zero
    for (const int exponent : {-5, 100, 270}) {
      model_->specials_i = static_cast<std::uint8_t>(specials);
      set(true, exponent, 0x5555555, static_cast<int>(random_() % 16));
      const std::uint32_t expected = (specials & 16) != 0  ? kFormat.quiet_nan()
                                     : (specials & 8) != 0 ? kFormat.sign_bit() | kFormat.infinity()
                                                           : kFormat.sign_bit();
      for (int kind = 0; kind < 2; ++kind) {
        ASSERT_EQ(model_->rounded_o >> 32 * kind & 0xffffffff, expected) << specials;
        ASSERT_EQ(model_->flags_o >> 5 * kind & 31, (specials & 3) << 3) << specials;
      }
    }
  }
}

}  // namespace
}  // namespace raygate
