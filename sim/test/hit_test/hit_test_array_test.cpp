// An array Verilated as a whole has the same results, clocks and counters as an array made of
// one-lane models, as RtlBurstUnit makes it.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <tuple>

#include "Vhit_test_array_2.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/test/same_results.h"
#include "sim/array_model.h"
#include "sim/random_bursts.h"

namespace raygate {
namespace {

constexpr int kTests = 20'000, kBatches = 10, kLanes = 2;

TEST(HitTestArray, IsItsLanesSideBySide) {
  RandomBursts random(kLanes);
  for (const auto& [no_test, not_taken] : {std::tuple{0, 0}, {64, 0}, {0, 230}, {40, 64}}) {
    const BurstStalls stalls{no_test, not_taken, kLanes};
    ArrayModel<Vhit_test_array_2, kLanes> whole(kLanes, stalls);
    RtlBurstUnit lanes(kLanes, Arith::kStructural, stalls);
    for (int i = 0; i < kBatches; ++i) {
      const BurstBatch batch = random.make(kTests / kBatches);
      BurstResults expected, got;
      whole.start(batch.bundles);
      whole.finish(expected);
      lanes.run(batch.bundles, got);
      ASSERT_NO_THROW(require_same(batch.bundles, got, expected));
    }
    using Words = std::array<std::uint64_t, sizeof(HitCounters) / sizeof(std::uint64_t)>;
    EXPECT_EQ(std::bit_cast<Words>(lanes.counters()), std::bit_cast<Words>(whole.counters()));
    EXPECT_GE(whole.counters().tests, std::uint64_t{kTests});
  }
}

}  // namespace
}  // namespace raygate
