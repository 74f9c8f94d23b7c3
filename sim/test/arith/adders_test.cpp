// Every kind of adder at 10 widths from 1 to 64 against the CPU's integers.
#include <gtest/gtest.h>

#include <cstdint>

#include "Vadders_top.h"
#include "sim/model.h"
#include "sim/test/arith/cases.h"

namespace raygate {
namespace {

constexpr std::uint32_t kAllWidths = 0x3ff;
constexpr std::uint32_t kAllKinds = 0x1ff;

class AddersTest : public testing::Test {
 protected:
  /// Adds, and holds all adders against a + b + carry + error.
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
  }

  /// Checks until something is wrong.
  auto checked() {
    return [this](std::uint64_t a, std::uint64_t b, bool carry) {
      if (!HasFatalFailure()) check(a, b, carry);
    };
  }

  Model<Vadders_top> model_;
};

// The check itself: a sum that is wrong in its lowest bit is wrong in every adder.
TEST_F(AddersTest, WrongSumIsSeenInEveryAdder) {
  add(0, 0, false);
  ASSERT_EQ(model_->wrong_width_o, 0u);
  add(0x123456789abcdef0, 0x0fedcba987654321, false, 1);
  EXPECT_EQ(model_->wrong_width_o, kAllWidths);
  EXPECT_EQ(model_->wrong_kind_o, kAllKinds);
}

TEST_F(AddersTest, ExhaustiveUpToEightBits) { all_sums_of_8_bits(checked()); }
TEST_F(AddersTest, CarryChains) { carry_chains(checked()); }
TEST_F(AddersTest, RandomRuns) { random_runs(checked()); }

}  // namespace
}  // namespace raygate
