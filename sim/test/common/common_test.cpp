// fifo and delay_line against std::deque, with random pushes, pops, pauses and resets; and that the
// checks of sim/checks and random register contents work at all.
#include <gtest/gtest.h>
#include <unistd.h>

#include <deque>
#include <random>

#include "Vcommon_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr unsigned kSeed = 20260201;

class CommonTest : public testing::Test {
 protected:
  CommonTest() {
    model_->push_i = model_->pop_i = model_->enable_i = 0;
    model_.reset();
  }

  Model<Vcommon_top> model_;
  std::mt19937 random_{kSeed};
};

TEST_F(CommonTest, FifosKeepEveryWordInOrder) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::deque<std::uint32_t> fifos[3];
  std::uint64_t popped = 0, full = 0;
  for (int clock = 0; clock < 200'000; ++clock) {
    // How eager both sides are changes, so that the FIFOs run full and empty.
    const unsigned push_of_8 = 1 + clock / 1000 % 7, pop_of_8 = 1 + clock / 7000 % 7;
    unsigned push = 0, pop = 0;
    model_->data_i = random_();
    for (unsigned n = 0; n < 3; ++n) {
      ASSERT_EQ(model_->space_o >> n & 1, fifos[n].size() < 2u << n) << "clock " << clock;
      ASSERT_EQ(model_->valid_o >> n & 1, !fifos[n].empty()) << "clock " << clock;
      if (!fifos[n].empty()) {
        ASSERT_EQ(model_->word_o[n], fifos[n].front()) << "clock " << clock;
      }
      full += fifos[n].size() == 2u << n;
      if (!fifos[n].empty() && random_() % 8 < pop_of_8) pop |= 1u << n;
      if ((model_->space_o >> n & 1) != 0 && random_() % 8 < push_of_8) push |= 1u << n;
    }
    model_->push_i = push;
    model_->pop_i = pop;
    model_.clock();
    for (unsigned n = 0; n < 3; ++n) {
      popped += pop >> n & 1;
      if ((pop >> n & 1) != 0) fifos[n].pop_front();
      if ((push >> n & 1) != 0) fifos[n].push_back(model_->data_i);
    }
    if (random_() % 10'000 == 0) {
      model_.reset();
      for (auto& fifo : fifos) fifo.clear();
    }
  }
  EXPECT_GT(popped, 100'000u);
  EXPECT_GT(full, 10'000u);
}

TEST_F(CommonTest, DelayLinesCountOnlyClocksWithEnable) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::deque<std::uint32_t> taken;  // the latest first
  for (int clock = 0; clock < 10'000; ++clock) {
    model_->data_i = random_();
    model_->enable_i = random_() % 3 != 0;
    model_.eval();
    EXPECT_EQ(model_->delayed_o[0], model_->data_i);  // a wire
    model_.clock();
    if (model_->enable_i) taken.push_front(model_->data_i);
    for (std::size_t depth = 1; depth < 6; ++depth) {
      if (taken.size() < depth) continue;
      ASSERT_EQ(model_->delayed_o[depth], taken[depth - 1]) << depth << " clocks";
    }
  }
}

class CommonDeathTest : public CommonTest {
 protected:
  CommonDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

  /// Clocks with these pushes and pops; Verilator says on standard output what stopped it.
  void run(unsigned push, unsigned pop, int clocks) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    model_->push_i = push;
    model_->pop_i = pop;
    for (int i = 0; i < clocks; ++i) model_.clock();
  }
};

TEST_F(CommonDeathTest, PushIntoAFullFifoStopsTheSimulation) {
  EXPECT_DEATH(run(1, 0, 3), "a_no_overflow");
}

TEST_F(CommonDeathTest, PopOfAnEmptyFifoStopsTheSimulation) {
  EXPECT_DEATH(run(0, 4, 1), "a_no_underflow");
}

// What RAYGATE_RANDOM_RESET promises, and without it zeros.
TEST(RandomResetTest, RegistersWithoutResetStartAsTheSeedSays) {
  const auto contents = [](const char* seed) {
    if (seed != nullptr) {
      setenv("RAYGATE_RANDOM_RESET", seed, 1);
    } else {
      unsetenv("RAYGATE_RANDOM_RESET");
    }
    Model<Vcommon_top> model;
    unsetenv("RAYGATE_RANDOM_RESET");
    return std::vector<std::uint32_t>{model->delayed_o[1], model->delayed_o[2],
                                      model->delayed_o[5]};
  };
  EXPECT_EQ(contents(nullptr), (std::vector<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(contents("1"), contents("1"));
  EXPECT_NE(contents("1"), contents("2"));
}

}  // namespace
}  // namespace raygate
