// fifo, ram_fifo, ram and delay_line against std::deque and an array, with random
// pushes, pops, pauses and resets; and that the checks of sim/checks and random register contents
// work at all.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
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
    model_->push_i = model_->pop_i = model_->enable_i = model_->write_i = model_->read_i = 0;
    model_.reset();
  }

  Model<Vcommon_top> model_;
  std::mt19937 random_{kSeed};
};

TEST_F(CommonTest, FifosKeepEveryWordInOrder) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::deque<std::uint32_t> fifos[6];  // the last three: in memories
  unsigned late = 0;                   // those whose last word came in the clock before
  std::uint64_t popped = 0, full = 0;
  for (int clock = 0; clock < 200'000; ++clock) {
    // How eager both sides are changes, so that the FIFOs run full and empty.
    const unsigned push_of_8 = 1 + clock / 1000 % 7, pop_of_8 = 1 + clock / 7000 % 7;
    unsigned push = 0, pop = 0;
    model_->data_i = random_();
    for (unsigned n = 0; n < 6; ++n) {
      ASSERT_EQ(model_->space_o >> n & 1, fifos[n].size() < 2u << n % 3) << "clock " << clock;
      const bool valid = fifos[n].size() > (late >> n & 1);
      ASSERT_EQ(model_->valid_o >> n & 1, valid) << "clock " << clock;
      if (valid) {
        ASSERT_EQ(model_->word_o[n], fifos[n].front()) << "clock " << clock;
      }
      full += fifos[n].size() == 2u << n % 3;
      if (valid && random_() % 8 < pop_of_8) pop |= 1u << n;
      if ((model_->space_o >> n & 1) != 0 && random_() % 8 < push_of_8) push |= 1u << n;
    }
    model_->push_i = push;
    model_->pop_i = pop;
    model_.clock();
    late = push & 0x38;
    for (unsigned n = 0; n < 6; ++n) {
      popped += pop >> n & 1;
      if ((pop >> n & 1) != 0) fifos[n].pop_front();
      if ((push >> n & 1) != 0) fifos[n].push_back(model_->data_i);
    }
    if (random_() % 10'000 == 0) {
      model_.reset();
      for (auto& fifo : fifos) fifo.clear();
      late = 0;
    }
  }
  EXPECT_GT(popped, 100'000u);
  EXPECT_GT(full, 10'000u);
}

TEST_F(CommonTest, MemoriesGiveTheWordBefore) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::array<std::uint32_t, 16> words{};
  std::uint32_t expected = 0;
  unsigned together = 0;
  for (int clock = 0; clock < 20'000; ++clock) {
    model_->data_i = random_();
    model_->write_i = clock < 16 ? 0xf : random_() % 16;
    model_->write_address_i = clock < 16 ? clock : random_() % 16;
    model_->read_i = clock == 16 || random_() % 3 != 0;
    model_->read_address_i = random_() % 16;
    if (model_->read_i != 0) expected = words[model_->read_address_i];
    together += model_->read_i != 0 && model_->write_i != 0 &&
                model_->read_address_i == model_->write_address_i;
    for (unsigned byte = 0; byte < 4; ++byte) {
      if ((model_->write_i >> byte & 1) == 0) continue;
      const std::uint32_t mask = 0xffu << 8 * byte;
      std::uint32_t& word = words[model_->write_address_i];
      word = (word & ~mask) | (model_->data_i & mask);
    }
    model_.clock();
    if (clock >= 16) {
      ASSERT_EQ(model_->read_o, expected);
    }
  }
  EXPECT_GT(together, 100u);
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
