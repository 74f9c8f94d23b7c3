// What tests in place find against what batches to the reference model find.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "host/find/cpu/cpu_finder.h"
#include "host/find/unit/pipeline_hit_tester.h"
#include "host/find/unit/reference_burst_unit.h"
#include "host/find/unit/unit_finder.h"

namespace raygate::test {

inline std::unique_ptr<Finder> reference_finder(const Bvh& bvh) {
  return std::make_unique<UnitFinder>(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<ReferenceBurstUnit>()));
}

/// What the tests in place did.
struct InPlace {
  int hits = 0;
  HitCounters counters;
};

/// Expects what both find to be the same, P's bits included; and each ray's counts to add up.
inline InPlace compare_in_place(const Bvh& bvh, std::span<const Ray> rays, Search search) {
  CpuFinder in_place(bvh);
  std::vector<NearestHit> found(rays.size()), expected(rays.size());
  reference_finder(bvh)->find(rays, search, expected);
  std::vector<RayWork> work(rays.size());
  search.work = work;
  in_place.find(rays, search, found);
  InPlace done;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit &a = found[i], &b = expected[i];
    if (search.enough_before.empty()) {
      EXPECT_EQ(a.slot, b.slot) << i;
      if (search.ignored.empty()) {
        EXPECT_EQ(std::memcmp(&a.point, &b.point, sizeof a.point), 0) << i;
        EXPECT_EQ(a.point_error, b.point_error) << i;
      }
      EXPECT_LE(a.t.low, b.t.high);
      EXPECT_GE(a.t.high, b.t.low);
    } else {
      EXPECT_EQ(a.slot == NearestHit::kNone, b.slot == NearestHit::kNone) << i;
    }
    done.hits += a.slot != NearestHit::kNone;
  }
  done.counters = in_place.counters().hit;
  EXPECT_EQ(done.counters.tests,
            done.counters.misses + done.counters.hits + done.counters.edge_doubts);
  RayWork sum;
  for (const RayWork& ray : work) {
    sum.tests += ray.tests;
    sum.doubts += ray.doubts;
  }
  EXPECT_EQ(sum.tests, done.counters.tests);
  EXPECT_EQ(sum.doubts, done.counters.edge_doubts);
  return done;
}

}  // namespace raygate::test
