// Compares Booth multipliers of widths from 2 to 32 with the CPU's integers.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "Vmultipliers_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::array kWidths = {2, 3, 4, 5, 6, 7, 8, 9, 11, 16, 23, 32};  // as in the top

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

  Model<Vmultipliers_top> model_;
};

// Exhaustive in the lowest eight bits. The upper bits, for wider multipliers, are random.
TEST_F(MultipliersTest, ExhaustiveUpToEightBits) {
  std::mt19937 random(1);
  for (std::uint32_t low = 0; low < 1 << 16; ++low) {
    const std::uint32_t a = (random() << 8) | (low & 0xff);
    const std::uint32_t b = (random() << 8) | (low >> 8);
    ASSERT_NO_FATAL_FAILURE(check(a, b));
  }
}

// Every Booth digit in every position, alone and among others; single bits, runs, and neighbours.
TEST_F(MultipliersTest, Structured) {
  std::vector<std::uint32_t> words = {0,          ~0u,        0x55555555, 0xaaaaaaaa,
                                      0x33333333, 0xcccccccc, 0x92492492, 0x6db6db6d};
  for (int bit = 0; bit < 32; ++bit) {
    const std::uint32_t one = 1u << bit;
    for (std::uint32_t word : {one, one - 1, one + 1, ~one, 3 * one, 5 * one, 7 * one, 0u - one}) {
      words.push_back(word);
    }
  }
  for (std::uint32_t a : words) {
    for (std::uint32_t b : words) ASSERT_NO_FATAL_FAILURE(check(a, b));
  }
}

TEST_F(MultipliersTest, Random) {
  std::mt19937 random(2);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint32_t a = random();
    ASSERT_NO_FATAL_FAILURE(check(a, static_cast<std::uint32_t>(random())));
  }
}

}  // namespace
}  // namespace raygate
