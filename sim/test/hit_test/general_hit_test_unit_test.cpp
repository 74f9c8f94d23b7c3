// Tests the general-form unit: its timetable, and random streams compared with C++ floats.
#include <gtest/gtest.h>

#include "Vgeneral_hit_test_unit_open.h"
#include "sim/bus_stream.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

using Point = std::array<std::uint32_t, 3>;

// Returns P = O + t I with t = -(d + N . O) / (N . I). Operations are in the unit's order.
Point expected(const BusTest<10>& test) {
  const auto word = [&](int k) { return from_bits(test.words[k]); };
  float numerator = word(0);
  for (int k = 0; k < 3; ++k) numerator += word(1 + k) * word(4 + k);
  float dot = word(1) * word(7);
  for (int k = 1; k < 3; ++k) dot += word(1 + k) * word(7 + k);
  const float t = -numerator / dot;
  Point point;
  for (int k = 0; k < 3; ++k) point[k] = bits(word(4 + k) + t * word(7 + k));
  return point;
}

TEST(GeneralHitTestUnit, MeetsThePlaneZEquals2) {
  // N = (0, 0, 1), d = -2. The ray from (1, 2, 3) along (1, 1, -1) hits at t = 1.
  const BusTest<10> test{
      {bits(-2), bits(0), bits(0), bits(1), bits(1), bits(2), bits(3), bits(1), bits(1), bits(-1)}};
  Model<Vgeneral_hit_test_unit_open> unit;
  unit.reset();
  EXPECT_EQ(stream_tests(unit, std::vector{test}).at(0).point, (Point{bits(2), bits(3), bits(2)}));
}

TEST(GeneralHitTestUnit, TakesATestEvery10ClocksAndAnswersIn15) {
  Model<Vgeneral_hit_test_unit_open> unit;
  unit.reset();
  const auto results = stream_tests(unit, std::vector<BusTest<10>>(100));
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].first_word, 1 + 10 * i);
    EXPECT_EQ(results[i].last_component, 15 + 10 * i);
  }
  for (int clock = 0; clock < 30; ++clock) {
    unit->valid_i = 0;
    unit.clock();
    EXPECT_FALSE(unit->valid_o);
    EXPECT_TRUE(unit->ready_o);
  }
}

TEST(GeneralHitTestUnit, RandomStreamsEqualFloatArithmetic) {
  constexpr std::uint32_t kSeed = 20260102;
  constexpr std::size_t kTests = 50'000;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  FloatStream floats(kSeed);
  std::vector<BusTest<10>> tests(kTests);
  for (auto& test : tests) {
    floats.next_test();
    for (auto& word : test.words) word = std::bit_cast<std::uint32_t>(floats());
    test.gap = floats.gap();
  }
  Model<Vgeneral_hit_test_unit_open> unit;
  unit.reset();
  const auto results = stream_tests(unit, tests);
  ASSERT_EQ(results.size(), kTests);
  for (std::size_t i = 0; i < kTests; ++i) {
    ASSERT_EQ(results[i].point, expected(tests[i])) << "test " << i;
    ASSERT_EQ(results[i].last_component, results[i].first_word + 14) << "test " << i;
  }
}

}  // namespace
}  // namespace raygate
