// Tests the paper's unit: worked example, timetable, and random streams compared with C++ floats.
#include <gtest/gtest.h>

#include "Vhit_test_unit_open.h"
#include "Vhit_test_unit_open___024root.h"
#include "Vhit_test_unit_paper.h"
#include "Vhit_test_unit_structural.h"
#include "sim/bus_stream.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

using Point = std::array<std::uint32_t, 3>;

// Section 4.2 of the paper: I = (3.3125, 5.875, 2.921875), H = (15.1875, 0.46875, 2.109375) and
// d = 1.75, the only values that give the paper's results.
const BusTest<7> kWorkedExample{{bits(3.3125f), bits(5.875f), bits(2.921875f), bits(15.1875f),
                                 bits(0.46875f), bits(2.109375f), bits(1.75f)}};

TEST(HitTestUnit, WorkedExampleWithItsIntermediateValues) {
  Model<Vhit_test_unit_open> unit;
  unit.reset();
  std::vector<std::uint32_t> products;  // products that enter the divider
  std::uint32_t dot = 0;
  const auto* inside = unit->rootp;
  const auto results = stream_tests(unit, std::vector{kWorkedExample}, [&] {
    if (!inside->hit_test_unit__DOT__divide) return;
    dot = inside->hit_test_unit__DOT__divisor_q;
    products.push_back(inside->hit_test_unit__DOT__product);
  });
  EXPECT_EQ(dot, 0x426CE740u);
  EXPECT_EQ(products, (std::vector<std::uint32_t>{0x40B98000, 0x41248000, 0x40A3A000}));
  EXPECT_EQ(results.at(0).point, (Point{0x3DC873FD, 0x3E31C2A2, 0x3DB0D093}));
}

// kHeld: the words that registers I-1, I-2, I-3, N and d hold after each edge, for two consecutive
// tests. Words 0 to 6 are Ix to d of the first test, 7 to 13 of the second; kAny is not checked.
TEST(HitTestUnit, RegistersAsFigure4DrawsThem) {
  constexpr int kAny = -1;
  constexpr int kHeld[14][5] = {
      {kAny, kAny, kAny, 0, kAny}, {kAny, kAny, 0, 1, kAny},  // Ix, Iy, Iz through N
      {kAny, 0, 1, 2, kAny},       {0, 1, 2, 3, kAny},        // a in N; I in its place
      {1, 2, 0, 4, kAny},          {2, 0, 1, 5, kAny},        // I rotates
      {0, 1, 2, kAny, 6},                                     // word d in d
      {1, 2, kAny, 7, 6},          {2, kAny, 7, 8, 6},        // the next I follows
      {kAny, 7, 8, 9, 6},          {7, 8, 9, 10, 6},         {8, 9, 7, 11, 6}, {9, 7, 8, 12, 6},
      {7, 8, 9, kAny, 13}};
  Model<Vhit_test_unit_open> unit;
  unit.reset();
  std::vector<BusTest<7>> tests(2);
  for (std::uint32_t word = 0; word < 14; ++word) {
    tests[word / 7].words[word % 7] = bits(1.0f + static_cast<float>(word));
  }
  std::size_t edge = 0;
  const auto* inside = unit->rootp;
  stream_tests(unit, tests, [&] {
    if (edge == 14) return;
    const std::uint32_t held[5] = {
        inside->hit_test_unit__DOT__direction_1_q, inside->hit_test_unit__DOT__direction_2_q,
        inside->hit_test_unit__DOT__direction_3_q, inside->hit_test_unit__DOT__normal_q,
        inside->hit_test_unit__DOT__d_q};
    for (int k = 0; k < 5; ++k) {
      const int word = kHeld[edge][k];
      if (word == kAny) continue;
      EXPECT_EQ(held[k], tests[word / 7].words[word % 7])
          << "edge " << edge + 1 << ", register " << k;
    }
    ++edge;
  });
  EXPECT_EQ(edge, 14u);
}

TEST(HitTestUnit, WorkedExampleWithThePapersDivider) {
  Model<Vhit_test_unit_paper> unit;
  unit.reset();
  const auto results = stream_tests(unit, std::vector{kWorkedExample});
  EXPECT_EQ(results.at(0).point, (Point{0x3DC873F8, 0x3E31C2A0, 0x3DB0D090}));
}

TEST(HitTestUnit, TakesATestEvery7ClocksAndAnswersIn10) {
  Model<Vhit_test_unit_structural> unit;
  unit.reset();
  const auto results = stream_tests(unit, std::vector(100, kWorkedExample));
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].first_word, 1 + 7 * i);
    EXPECT_EQ(results[i].last_component, 10 + 7 * i);
  }
  for (int clock = 0; clock < 30; ++clock) {  // the unit then has no further output
    unit->valid_i = 0;
    unit.clock();
    EXPECT_FALSE(unit->valid_o);
    EXPECT_TRUE(unit->ready_o);
  }
}

TEST(HitTestUnit, ResetEndsATestHalfway) {
  Model<Vhit_test_unit_structural> unit;
  for (int clocks = 1; clocks < 12; ++clocks) {
    unit.reset();
    for (int k = 0; k < clocks; ++k) {
      unit->valid_i = k == 0;
      unit->bus_i = kWorkedExample.words[k % 7];
      unit.clock();
    }
    unit.reset();
    EXPECT_FALSE(unit->valid_o);
    EXPECT_EQ(stream_tests(unit, std::vector{kWorkedExample}).at(0).point,
              point_of(kWorkedExample.words));
  }
}

TEST(HitTestUnit, RandomStreamsEqualFloatArithmetic) {
  constexpr std::uint32_t kSeed = 20260101;
  constexpr std::size_t kTests = 100'000;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  FloatStream floats(kSeed);
  std::vector<BusTest<7>> tests(kTests);
  for (auto& test : tests) {
    floats.next_test();
    for (auto& word : test.words) word = std::bit_cast<std::uint32_t>(floats());
    test.gap = floats.gap();
  }
  Model<Vhit_test_unit_structural> unit;
  unit.reset();
  const auto results = stream_tests(unit, tests);
  ASSERT_EQ(results.size(), kTests);
  for (std::size_t i = 0; i < kTests; ++i) {
    ASSERT_EQ(results[i].point, point_of(tests[i].words)) << "test " << i;
    ASSERT_EQ(results[i].last_component, results[i].first_word + 9) << "test " << i;
  }
}

}  // namespace
}  // namespace raygate
