// Leading-zero counters of all widths from 2 to 64: exhaustively up to 14 bits, every position of
// the leading one above.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>

#include "Vleading_zeros_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

class LeadingZerosTest : public testing::Test {
 protected:
  void check(std::uint64_t a) {
    model_->a_i = a;
    model_.clock();
    for (int width = 2; width <= 64; ++width) {
      const std::uint64_t word = a & ~std::uint64_t{0} >> (64 - width);
      const unsigned got = model_->count_o[width / 4] >> (8 * (width % 4)) & 0xff;
      ASSERT_EQ(got >> 7, word == 0) << width << " bits: " << std::hex << word;
      if (word == 0) continue;  // no count
      ASSERT_EQ(static_cast<int>(got), std::countl_zero(word) - (64 - width))
          << width << " bits: " << std::hex << word;
    }
  }

  Model<Vleading_zeros_top> model_;
};

TEST_F(LeadingZerosTest, ExhaustiveUpToFourteenBits) {
  for (std::uint64_t a = 0; a < 1 << 14; ++a) ASSERT_NO_FATAL_FAILURE(check(a));
}

TEST_F(LeadingZerosTest, EveryPositionWithAnyBitsBelow) {
  std::mt19937_64 random(1);
  for (int shift = 0; shift < 64; ++shift) {
    const std::uint64_t one = std::uint64_t{1} << (63 - shift);
    for (std::uint64_t below :
         {std::uint64_t{0}, ~std::uint64_t{0}, random(), random(), random()}) {
      ASSERT_NO_FATAL_FAILURE(check(one | (below & (one - 1))));
    }
  }
}

}  // namespace
}  // namespace raygate
