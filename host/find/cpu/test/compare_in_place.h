// A wavefront that tests in place against one that sends batches.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <span>

#include "host/find/unit/cpu_burst_unit.h"
#include "host/find/unit/cpu_hit_tester.h"
#include "host/find/unit/pipeline_hit_tester.h"
#include "host/find/unit/wavefront.h"

namespace raygate::test {

/// What the tests in place did.
struct InPlace {
  int hits = 0;
  HitCounters counters;
};

/// Expects what both find to be the same, P's bits included. `search` is that in place, `reference`
/// the same with records of its own.
inline InPlace compare_in_place(const Bvh& bvh, std::span<const Ray> rays, const Search& search,
                                const Search& reference) {
  CpuHitTester in_place;
  PipelineHitTester batches(std::make_unique<CpuBurstUnit>());
  Wavefront tested(bvh, in_place), expected(bvh, batches);
  tested.trace(rays, search);
  expected.trace(rays, reference);
  InPlace done;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit &a = tested.nearest(i), &b = expected.nearest(i);
    if (search.enough_before.empty()) {
      EXPECT_EQ(a.slot, b.slot) << i;
      if (search.ignored.empty()) {
        EXPECT_EQ(std::memcmp(&a.point, &b.point, sizeof a.point), 0) << i;
      }
      EXPECT_LE(a.t.low, b.t.high);
      EXPECT_GE(a.t.high, b.t.low);
    } else {
      EXPECT_EQ(a.slot == NearestHit::kNone, b.slot == NearestHit::kNone) << i;
    }
    done.hits += a.slot != NearestHit::kNone;
  }
  EXPECT_EQ(tested.own_records(), 0u);
  done.counters = in_place.counters();
  EXPECT_EQ(done.counters.tests,
            done.counters.misses + done.counters.hits + done.counters.edge_doubts);
  return done;
}

}  // namespace raygate::test
