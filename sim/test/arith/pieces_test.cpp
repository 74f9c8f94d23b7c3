// The small modules of hw/arith, each by itself, against integers; the divider's row and its
// stages.
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "Vpieces_top.h"
#include "sim/model.h"
#include "sim/test/arith/cases.h"

namespace raygate {
namespace {

constexpr unsigned kSeed = 20260202;
constexpr unsigned kAllPieces = 0xffff;

class PiecesTest : public testing::Test {
 protected:
  PiecesTest() { model_->spoil_i = model_->valid_i = 0; }

  void check(std::uint64_t a, std::uint64_t b, std::uint64_t c, bool carry) {
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 48) - 1;
    model_->a_i = a & kMask;
    model_->b_i = b & kMask;
    model_->c_i = c & kMask;
    model_->carry_i = carry;
    model_.clock();
    ++checked_;
  }

  Model<Vpieces_top> model_;
  std::mt19937_64 random_{kSeed};
  int checked_ = 0;
};

// The check itself.
TEST_F(PiecesTest, WrongExpectationsAreSeenInEveryPiece) {
  model_->spoil_i = 1;
  check(0x123456789abc, 0xfedcba987654, 0x0f0f0f0f0f0f, false);
  EXPECT_EQ(model_->wrong_o, kAllPieces);
}

TEST_F(PiecesTest, GiveWhatTheOperatorsGive) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const auto each = [this](std::uint64_t a, std::uint64_t b, bool carry) {
    check(a, b, random_(), carry);
    ASSERT_EQ(model_->wrong_o, 0u) << std::hex << a << ' ' << b << ' ' << carry;
  };
  const auto until_wrong = [&](std::uint64_t a, std::uint64_t b, bool carry) {
    if (!HasFatalFailure()) each(a, b, carry);
  };
  random_runs(until_wrong);
  carry_chains(until_wrong);
  EXPECT_GT(checked_, 100'000);
}

// Every divisor interval with residuals up to 2/3 of the divisor, split into two words at random.
TEST_F(PiecesTest, RowsOfTheDividerKeepTheResidualSmall) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (int i = 0; i < 500'000; ++i) {
    const std::int64_t d = (1 << 23) | static_cast<std::int64_t>(random_() & 0x7fffff);
    const std::int64_t most = 2 * d / 3;
    std::int64_t w =
        static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(2 * most + 1)) - most;
    if (i % 8 == 0) w = i % 16 == 0 ? most : -most;
    const auto sum = static_cast<std::uint32_t>(random_()) & 0x1ffffff;
    model_->row_divisor_i = static_cast<std::uint32_t>(d);
    model_->row_sum_i = sum;
    model_->row_carry_i = static_cast<std::uint32_t>(w - sum) & 0x1ffffff;
    model_.clock();
    ASSERT_EQ(model_->row_wrong_o, 0u) << std::hex << d << ' ' << w << ' ' << sum;
  }
}

TEST_F(PiecesTest, RightShiftsSayWhetherAOneWasLost) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (int i = 0; i < 200'000; ++i) {
    const std::uint64_t a = (random_() & 0xffffffffffff) << random_() % 48 & 0xffffffffffff;
    const std::uint64_t amount = random_() % (i % 2 == 0 ? 50 : 512);
    model_->a_i = a;
    model_->b_i = amount;
    model_.clock();
    const std::uint64_t shifted = amount < 48 ? a >> amount : 0;
    ASSERT_EQ(model_->shifted_o, shifted) << std::hex << a << " >> " << amount;
    ASSERT_EQ(model_->lost_o, amount < 48 ? shifted << amount != a : a != 0)
        << std::hex << a << " >> " << amount;
  }
}

// In one go; and pipelined, with idle clocks.
TEST_F(PiecesTest, DividersGiveTheQuotientAndWhetherAnythingIsLeft) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  constexpr std::size_t kLatency = 12 + 3;
  struct Division {
    bool valid;
    std::uint64_t result, pipelined;
  };
  std::deque<Division> stages;
  int divisions = 0;
  for (int clock = 0; clock < 200'000; ++clock) {
    const std::uint64_t x = 1 << 23 | (random_() & 0x7fffff), d = 1 << 23 | (random_() & 0x7fffff);
    const std::uint64_t dividend = clock % 16 == 0 ? d : x, scaled = 2 * dividend << 24;
    model_->dividend_i = static_cast<std::uint32_t>(dividend);
    model_->divisor_i = static_cast<std::uint32_t>(d);
    model_->valid_i = random_() % 4 != 0;
    model_.eval();
    const std::uint64_t result = scaled / d << 1 | (scaled % d != 0 ? 1 : 0);
    for (int kind = 0; kind < 2 && model_->valid_i; ++kind) {
      ASSERT_EQ(model_->quotient_o >> 32 * kind & 0xffffffff, result) << kind;
    }
    ASSERT_FALSE(model_->first_wrong_o) << std::hex << dividend << ' ' << d;
    const std::uint64_t side = (dividend & 0x3ff) << 10 | (d & 0x3ff);
    stages.push_front({model_->valid_i != 0, result, result | side << 27});
    model_.clock();
    if (stages.size() < kLatency) continue;
    const Division& due = stages[kLatency - 1];
    stages.resize(kLatency);
    for (int kind = 0; kind < 2; ++kind) {
      ASSERT_EQ(model_->valid_o >> kind & 1, due.valid) << "clock " << clock;
      if (!due.valid) continue;
      std::uint64_t got = 0;
      for (int bit = 0; bit < 48; ++bit) {
        const int place = 48 * kind + bit;
        got |= static_cast<std::uint64_t>(model_->pipelined_o[place / 32] >> place % 32 & 1) << bit;
      }
      ASSERT_EQ(got, due.pipelined) << "clock " << clock;
      ++divisions;
    }
  }
  EXPECT_GT(divisions, 100'000);
}

}  // namespace
}  // namespace raygate
