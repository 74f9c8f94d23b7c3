// Tests that the checks of sim/checks stop a simulation, and that registers start with random
// contents. `make prove` proves FIFOs and arbiter; tests of cores cover memories and delay lines.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "Vcommon_top.h"
#include "sim/model.h"

namespace raygate {
namespace {

class CommonDeathTest : public testing::Test {
 protected:
  CommonDeathTest() {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    model_->push_i = model_->pop_i = 0;
    model_.reset();
  }

  /// Runs `clocks` clocks with constant push and pop. Redirects Verilator's report to stderr.
  void run(bool push, bool pop, int clocks) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    model_->push_i = push;
    model_->pop_i = pop;
    for (int i = 0; i < clocks; ++i) model_.clock();
  }

  Model<Vcommon_top> model_;
};

TEST_F(CommonDeathTest, PushIntoAFullFifoStopsTheSimulation) {
  EXPECT_DEATH(run(true, false, 3), "a_no_overflow");
}

TEST_F(CommonDeathTest, PopOfAnEmptyFifoStopsTheSimulation) {
  EXPECT_DEATH(run(false, true, 1), "a_no_underflow");
}

// Registers start with random bits from seed RAYGATE_RANDOM_RESET, or with zeros if that is unset.
TEST(RandomResetTest, RegistersWithoutResetStartAsTheSeedSays) {
  const auto contents = [](const char* seed) {
    if (seed != nullptr) {
      setenv("RAYGATE_RANDOM_RESET", seed, 1);
    } else {
      unsetenv("RAYGATE_RANDOM_RESET");
    }
    Model<Vcommon_top> model;
    unsetenv("RAYGATE_RANDOM_RESET");
    return model->delayed_o;
  };
  EXPECT_EQ(contents(nullptr), 0u);
  EXPECT_EQ(contents("1"), contents("1"));
  EXPECT_NE(contents("1"), contents("2"));
}

}  // namespace
}  // namespace raygate
