// Booth multipliers of widths from 2 to 32 against the CPU's integers.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "Vmultipliers_top.h"
#include "sim/model.h"
#include "sim/test/arith/cases.h"

namespace raygate {
namespace {

constexpr std::array kWidths = {2, 3, 4, 5, 6, 7, 8, 9, 11, 16, 23, 32};  // as multipliers_top.sv

class MultipliersTest : public testing::Test {
 protected:
  void check(std::uint32_t a, std::uint32_t b) {
    model_->a_i = a;
    model_->b_i = b;
    model_.clock();
    for (std::size_t k = 0; k < 2 * kWidths.size(); ++k) {
      const int width = kWidths[k / 2];
      const std::uint64_t mask = (std::uint64_t{1} << width) - 1;
      ASSERT_EQ(word(model_->product_o, k), (a & mask) * (b & mask))
          << width << " bits, ConstantRow " << k % 2 << ": " << std::hex << (a & mask) << " * "
          << (b & mask);
    }
    for (std::size_t k = 0; k < kWidths.size(); ++k) {
      const std::uint64_t mask = (std::uint64_t{1} << kWidths[k]) - 1;
      ASSERT_EQ(word(model_->product_own_o, k), (a & mask) * (b & mask))
          << kWidths[k] << " bits, `*`: " << std::hex << (a & mask) << " * " << (b & mask);
    }
    for (int kind = 0; kind < 4; ++kind) {
      ASSERT_EQ(word(model_->product_24_o, kind), std::uint64_t{a & 0xffffff} * (b & 0xffffff))
          << "adder " << kind << ": " << std::hex << a << " * " << b;
    }
  }

  template <class Words>
  static std::uint64_t word(const Words& words, std::size_t index) {
    return words[2 * index] | static_cast<std::uint64_t>(words[2 * index + 1]) << 32;
  }

  /// Checks until something is wrong.
  auto checked() {
    return [this](std::uint32_t a, std::uint32_t b) {
      if (!HasFatalFailure()) check(a, b);
    };
  }

  Model<Vmultipliers_top> model_;
};

TEST_F(MultipliersTest, ExhaustiveUpToEightBits) { all_products_of_8_bits(checked()); }
TEST_F(MultipliersTest, Structured) { structured_products(checked()); }
TEST_F(MultipliersTest, Random) { random_products(checked()); }

}  // namespace
}  // namespace raygate
