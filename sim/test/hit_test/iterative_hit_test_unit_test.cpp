// Tests the iterative unit: timetable; random streams against C++ floats and the paper's unit.
#include <gtest/gtest.h>

#include "Viterative_hit_test_unit_behavioural.h"
#include "Viterative_hit_test_unit_structural.h"
#include "Vsiblings_top.h"
#include "sim/bus_stream.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

constexpr unsigned kClocks = 34;  // from a test's first word to its last component

template <class Top>
class IterativeHitTestUnit : public testing::Test {
 protected:
  Model<Top> unit_;
};

using Kinds =
    testing::Types<Viterative_hit_test_unit_structural, Viterative_hit_test_unit_behavioural>;
TYPED_TEST_SUITE(IterativeHitTestUnit, Kinds);

std::vector<BusTest<7>> random_tests(std::uint32_t seed, std::size_t count) {
  FloatStream floats(seed);
  std::vector<BusTest<7>> tests(count);
  for (auto& test : tests) {
    floats.next_test();
    for (auto& word : test.words) word = std::bit_cast<std::uint32_t>(floats());
    test.gap = floats.gap();
  }
  return tests;
}

TYPED_TEST(IterativeHitTestUnit, TakesATestEvery7Clocks) {
  this->unit_.reset();
  const auto results = stream_tests(this->unit_, std::vector<BusTest<7>>(100));
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].first_word, 1 + 7 * i);
    EXPECT_EQ(results[i].last_component, kClocks + 7 * i);
  }
  for (int clock = 0; clock < 60; ++clock) {  // the unit then has no further output
    this->unit_->valid_i = 0;
    this->unit_.clock();
    EXPECT_FALSE(this->unit_->valid_o);
    EXPECT_TRUE(this->unit_->ready_o);
  }
}

TYPED_TEST(IterativeHitTestUnit, RandomStreamsEqualFloatArithmetic) {
  constexpr std::uint32_t kSeed = 20260103;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  const auto tests = random_tests(kSeed, 100'000);
  this->unit_.reset();
  const auto results = stream_tests(this->unit_, tests);
  ASSERT_EQ(results.size(), tests.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    ASSERT_EQ(results[i].point, point_of(tests[i].words)) << "test " << i;
    ASSERT_EQ(results[i].last_component, results[i].first_word + kClocks - 1) << "test " << i;
  }
}

// A reset ends tests at any stage, without effects on later tests.
TYPED_TEST(IterativeHitTestUnit, ResetEndsAllTestsThatHaveBegun) {
  const auto tests = random_tests(1, 20);
  for (int clocks = 1; clocks < 60; ++clocks) {
    this->unit_.reset();
    for (int k = 0; k < clocks; ++k) {
      this->unit_->valid_i = 1;
      this->unit_->bus_i = tests[k / 7].words[k % 7];
      this->unit_.clock();
    }
    this->unit_.reset();
    EXPECT_FALSE(this->unit_->valid_o);
    const auto results = stream_tests(this->unit_, tests);
    for (std::size_t i = 0; i < tests.size(); ++i) {
      ASSERT_EQ(results[i].point, point_of(tests[i].words)) << clocks << " clocks, test " << i;
    }
  }
}

// Other formats and rounding modes.
TEST(IterativeHitTestUnits, GiveTheWordsOfThePapersUnit) {
  constexpr std::size_t kKinds = 6;
  const auto tests = random_tests(20260104, 20'000);
  Model<Vsiblings_top> units;
  units.reset();
  std::array<std::vector<std::uint32_t>, kKinds> expected, found;
  std::size_t test = 0, word = 0;
  unsigned waited = 0;
  for (unsigned idle = 0; idle < 60; units.clock()) {
    const bool first = word == 0 && test < tests.size() && waited++ == tests[test].gap;
    units->valid_i = first;
    if (first || word != 0) {
      ASSERT_TRUE(word != 0 || units->ready_o);
      units->bus_i = tests[test].words[word];
      word = (word + 1) % 7;
      test += word == 0;
      waited = 0;
    }
    idle = test < tests.size() ? 0 : idle + 1;
    for (std::size_t n = 0; n < kKinds; ++n) {
      if (units->paper_valid_o >> n & 1) expected[n].push_back(units->paper_bus_o[n]);
      if (units->valid_o >> n & 1) found[n].push_back(units->bus_o[n]);
    }
  }
  for (std::size_t n = 0; n < kKinds; ++n) {
    ASSERT_EQ(expected[n].size(), 3 * tests.size());
    EXPECT_EQ(found[n], expected[n]) << "kind " << n;
  }
}

}  // namespace
}  // namespace raygate
