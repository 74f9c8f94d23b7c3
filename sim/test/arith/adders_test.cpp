// Compares every kind of adder, and leading-zero counters, at 10 widths from 1 to 64, with the
// CPU's integers.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "Vadders_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kAllWidths = 0x3ff;
constexpr std::uint32_t kAllKinds = 0x1ff;

class AddersTest : public testing::Test {
 protected:
  /// Adds a + b + carry in all adders. The sum that they are compared with is larger by `error`.
  void add(std::uint64_t a, std::uint64_t b, bool carry, unsigned __int128 error = 0) {
    const unsigned __int128 sum = static_cast<unsigned __int128>(a) + b + carry + error;
    model_->a_i = a;
    model_->b_i = b;
    model_->carry_i = carry;
    for (int word = 0; word < 3; ++word) {
      model_->expected_i[word] = static_cast<std::uint32_t>(sum >> (32 * word));
    }
    model_->expected_i[2] &= 1;
    model_.clock();
  }

  void check(std::uint64_t a, std::uint64_t b, bool carry) {
    add(a, b, carry);
    ASSERT_EQ(model_->wrong_width_o, 0u) << std::hex << a << " + " << b << " + " << carry;
    ASSERT_EQ(model_->wrong_kind_o, 0u) << std::hex << a << " + " << b << " + " << carry;
    ASSERT_EQ(model_->wrong_other_o, 0u) << std::hex << a << ", " << b << ", " << carry;
  }

  Model<Vadders_top> model_;
};

// Tests the check itself: with an expected sum that is off by one, every adder counts as wrong.
TEST_F(AddersTest, WrongSumIsSeenInEveryAdder) {
  add(0, 0, false);
  ASSERT_EQ(model_->wrong_width_o, 0u);
  add(0x123456789abcdef0, 0x0fedcba987654321, false, 1);
  EXPECT_EQ(model_->wrong_width_o, kAllWidths);
  EXPECT_EQ(model_->wrong_kind_o, kAllKinds);
}

// Exhaustive in the lowest eight bits. The upper bits, for wider adders, are random.
TEST_F(AddersTest, ExhaustiveUpToEightBits) {
  std::mt19937_64 random(1);
  for (std::uint64_t low = 0; low < 1 << 17; ++low) {
    const std::uint64_t a = (random() << 8) | (low & 0xff);
    const std::uint64_t b = (random() << 8) | (low >> 8 & 0xff);
    ASSERT_NO_FATAL_FAILURE(check(a, b, (low >> 16) != 0));
  }
}

// A carry from every bit to every higher bit, propagated through ones in either operand.
TEST_F(AddersTest, CarryChains) {
  std::mt19937_64 random(2);
  for (int first = 0; first < 64; ++first) {
    for (int last = first; last < 64; ++last) {
      const std::uint64_t above = last == 63 ? 0 : ~std::uint64_t{0} << (last + 1);
      const std::uint64_t chain = ~above & (~std::uint64_t{0} << first);
      const std::uint64_t birth = std::uint64_t{1} << first;
      const std::uint64_t split = random();
      ASSERT_NO_FATAL_FAILURE(check(chain, birth, false));
      ASSERT_NO_FATAL_FAILURE(check(chain & split, (chain & ~split) + birth, false));
      ASSERT_NO_FATAL_FAILURE(check(chain ^ birth, ~chain, first == 0));
      ASSERT_NO_FATAL_FAILURE(check(~chain, chain, true));
    }
  }
}

// Runs of zeros and ones of random lengths, which generate, propagate and kill carries.
TEST_F(AddersTest, RandomRuns) {
  std::mt19937_64 random(3);
  const auto runs = [&random] {
    std::uint64_t word = random();
    for (int k = random() % 4; k > 0; --k) word ^= ~std::uint64_t{0} << random() % 64;
    return random() % 2 != 0 ? word : word & random() & random();
  };
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t a = runs();
    const std::uint64_t b = random() % 2 != 0 ? runs() : ~a ^ (std::uint64_t{1} << random() % 64);
    ASSERT_NO_FATAL_FAILURE(check(a, b, random() % 2 != 0));
  }
}

}  // namespace
}  // namespace raygate
