#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <random>
#include <string>
#include <tuple>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/test/same_results.h"
#include "sim/random_bursts.h"
#include "sim/rtl_units.h"

namespace raygate {
namespace {

/// Returns the number of tests per array: RAYGATE_STRESS if it is set; otherwise a million for an
/// array of one lane, and 100,000 for an array of several lanes.
std::uint64_t tests_wanted(int lanes) {
  const char* wanted = std::getenv("RAYGATE_STRESS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : lanes == 1 ? 1'000'000 : 100'000;
}

void expect_same_events(const HitCounters& rtl, const HitCounters& cpu) {
  EXPECT_EQ(rtl.tests, cpu.tests);
  EXPECT_EQ(rtl.misses, cpu.misses);
  EXPECT_EQ(rtl.hits, cpu.hits);
  EXPECT_EQ(rtl.edge_doubts, cpu.edge_doubts);
  EXPECT_EQ(rtl.depth_doubts, cpu.depth_doubts);
  EXPECT_EQ(rtl.plane_tests, cpu.plane_tests);
}

class RtlBurstUnitTest : public testing::TestWithParam<std::tuple<Arith, int>> {};

/// Compares every field of every result, under random stalls, in many small and large batches. At
/// random, a batch starts before or after the previous batch is finished.
TEST_P(RtlBurstUnitTest, HasTheTwinsBits) {
  const auto [arith, lanes] = GetParam();
  const auto seed = static_cast<std::uint64_t>(lanes);
  RecordProperty("seed", static_cast<int>(seed));
  RandomBursts random(seed);
  std::mt19937_64 size(seed);
  ReferenceBurstUnit cpu;
  HitCounters rtl_total;
  std::uint64_t done = 0;
  const std::uint64_t wanted = tests_wanted(lanes);
  // Stalls: none, either kind, both, and so frequent that the unit mostly waits.
  for (const auto& [no_test, not_taken, share] : {std::tuple{0, 0, 4},
                                                  {64, 0, 8},
                                                  {0, 96, 8},
                                                  {40, 64, 4},
                                                  {200, 0, 16},
                                                  {0, 230, 16},
                                                  {100, 200, 8}}) {
    RtlBurstUnit rtl(lanes, arith, {no_test, not_taken, seed});
    std::deque<BurstBatch> started;
    const auto finish = [&] {
      BurstResults expected, got;
      cpu.run(started.front().bundles, expected);
      rtl.finish(got);
      require_same(started.front().bundles, got, expected);
      started.pop_front();
    };
    for (std::uint64_t part = 0; part < wanted / static_cast<std::uint64_t>(share);) {
      started.push_back(random.make(1 + size() % (size() % 2 == 0 ? 50 : 5'000)));
      rtl.start(started.back().bundles);
      part += started.back().tests;
      done += started.back().tests;
      if (started.size() == 2 || size() % 4 == 0) {
        ASSERT_NO_THROW(finish());
      }
    }
    while (!started.empty()) ASSERT_NO_THROW(finish());
    rtl_total += rtl.counters();
  }
  expect_same_events(rtl_total, cpu.counters());
  EXPECT_EQ(cpu.counters().tests, done);
  // The batches cover all verdicts.
  EXPECT_GT(cpu.counters().misses, done / 20);
  EXPECT_GT(cpu.counters().hits, done / 20);
  EXPECT_GT(cpu.counters().edge_doubts, done / 20);
  EXPECT_GT(cpu.counters().depth_doubts, done / 1000);
}

std::string name(const testing::TestParamInfo<std::tuple<Arith, int>>& info) {
  const auto [arith, lanes] = info.param;
  return (arith == Arith::kStructural ? "structural_" : "behavioural_") + std::to_string(lanes);
}

INSTANTIATE_TEST_SUITE_P(Lanes, RtlBurstUnitTest,
                         testing::Combine(testing::Values(Arith::kStructural, Arith::kBehavioural),
                                          testing::Values(1, 2, 4, 8)),
                         name);

}  // namespace
}  // namespace raygate
