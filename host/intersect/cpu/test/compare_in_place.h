// What tests in place find against what batches to the reference model find.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "host/base/vectors.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/intersect/unit/unit_hit_testers.h"
#include "host/intersect/unit/unit_intersector.h"

namespace raygate::test {

inline std::unique_ptr<Intersector> reference_intersector(const Bvh& bvh) {
  return std::make_unique<UnitIntersector>(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<ReferenceBurstUnit>()));
}

/// What the tests in place did.
struct InPlace {
  int hits = 0;
  HitCounters counters;
};

/// Expects the same of every vector code that the machine has: hits, bit by bit, and work.
inline void compare_vectors(const Bvh& bvh, std::span<const Ray> rays, RayQuery query,
                            std::span<const NearestHit> expected) {
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors in_use(vectors);
    std::vector<RayWork> work(rays.size());
    std::vector<NearestHit> found(rays.size());
    CpuIntersector intersector(bvh);
    const std::span<const RayWork> expected_work = query.work;
    RayQuery again = query;
    again.work = work;
    intersector.intersect(rays, again, found);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(found[i].primitive, expected[i].primitive) << i << ", " << name_of(vectors);
      EXPECT_EQ(work[i].tests, expected_work[i].tests) << i << ", " << name_of(vectors);
      EXPECT_EQ(work[i].doubts, expected_work[i].doubts) << i << ", " << name_of(vectors);
      if (found[i].primitive == NearestHit::kNone) continue;
      EXPECT_EQ(found[i].t.low, expected[i].t.low) << i << ", " << name_of(vectors);
      EXPECT_EQ(found[i].t.high, expected[i].t.high) << i << ", " << name_of(vectors);
      if (!query.skip_ids.empty() || !query.any_hit_before.empty()) continue;
      EXPECT_EQ(std::memcmp(&found[i].point, &expected[i].point, sizeof found[i].point), 0)
          << i << ", " << name_of(vectors);
    }
  }
}

/// Expects what both find to be the same, P's bits included, whatever vectors are used; and each
/// ray's counts to add up.
inline InPlace compare_in_place(const Bvh& bvh, std::span<const Ray> rays, RayQuery query) {
  CpuIntersector in_place(bvh);
  std::vector<NearestHit> found(rays.size()), expected(rays.size());
  reference_intersector(bvh)->intersect(rays, query, expected);
  std::vector<RayWork> work(rays.size());
  query.work = work;
  in_place.intersect(rays, query, found);
  compare_vectors(bvh, rays, query, found);
  InPlace done;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const NearestHit &a = found[i], &b = expected[i];
    if (query.any_hit_before.empty()) {
      EXPECT_EQ(a.primitive, b.primitive) << i;
      if (query.skip_ids.empty()) {
        EXPECT_EQ(std::memcmp(&a.point, &b.point, sizeof a.point), 0) << i;
        EXPECT_EQ(a.point_error, b.point_error) << i;
      }
      EXPECT_LE(a.t.low, b.t.high);
      EXPECT_GE(a.t.high, b.t.low);
    } else {
      EXPECT_EQ(a.primitive == NearestHit::kNone, b.primitive == NearestHit::kNone) << i;
    }
    done.hits += a.primitive != NearestHit::kNone;
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
