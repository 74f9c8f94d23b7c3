// The nearest hit does not depend on the order in which hits are reported.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/exact/test/meshes.h"
#include "host/intersect/intersector.h"

namespace raygate {
namespace {

const Ray kRay = {glm::vec3(0), glm::vec3(0, 0, 1)};

Corners at_depth(float z) {
  return {glm::vec3(-1, -1, z), glm::vec3(1, -1, z), glm::vec3(0, 1, z)};
}

/// An interval that says nothing.
NearestHit hit_of(std::uint32_t primitive) { return {.primitive = primitive, .t = {0.0, 10.0}}; }

// Five planes: two at the same depth, two an ulp apart, one farther; each order of their reports,
// as hits with intervals that say nothing and as doubts.
TEST(NearestHit, EveryOrderOfReportsGivesTheSame) {
  const float near = 1.0f, beyond = std::nextafter(1.0f, 2.0f);
  const std::vector<Corners> mesh = {at_depth(beyond), at_depth(2), at_depth(near), at_depth(near),
                                     at_depth(beyond)};
  const Bvh bvh(test::scene_of(mesh));
  std::vector<std::uint32_t> primitives = {0, 1, 2, 3, 4};
  IntersectCounters counters;
  do {
    for (int kind = 0; kind < 2; ++kind) {
      NearestHit best;
      for (const std::uint32_t primitive : primitives) {
        if (kind == 0) {
          take_if_nearer(bvh, kRay, INFINITY, hit_of(primitive), best, counters);
        } else {
          resolve_doubt(bvh, kRay, INFINITY, {.primitive = primitive}, best, counters);
        }
      }
      ASSERT_EQ(bvh.triangle_of(best.primitive), 2u);
    }
  } while (std::ranges::next_permutation(primitives).found);
  // No doubt that is surely farther than a hit is settled: of 120 orders, the two nearest always
  // are, those an ulp behind in the third in which they come before both, the last one where it is
  // first.
  EXPECT_EQ(counters.exact_inside, 2u * 120 + 2u * 40 + 24);
  EXPECT_GT(counters.exact_depth, 0u);
}

// The end of a ray is open, and exact: a hit an ulp before the limit counts, one at it does not,
// whatever the interval says.
TEST(NearestHit, NothingAtOrBeyondTheLimitCounts) {
  const float limit = 0.7f, before = std::nextafter(limit, 0.0f);
  const Bvh bvh(test::scene_of({at_depth(before), at_depth(limit)}));
  IntersectCounters counters;
  for (std::uint32_t primitive = 0; primitive < 2; ++primitive) {
    const bool expected = bvh.corners_of(primitive)[0].z < limit;
    NearestHit none, nothing;
    EXPECT_EQ(take_if_nearer(bvh, kRay, limit, hit_of(primitive), none, counters), expected);
    EXPECT_EQ(resolve_doubt(bvh, kRay, limit, {.primitive = primitive}, nothing, counters),
              expected);
  }
}

TEST(NearestHit, ADoubtThatIsAMissLeavesNothing) {
  const Bvh bvh(test::scene_of({at_depth(-1)}));
  IntersectCounters counters;
  NearestHit best;
  EXPECT_FALSE(resolve_doubt(bvh, kRay, INFINITY, {.primitive = 0}, best, counters));
  EXPECT_EQ(best.primitive, NearestHit::kNone);
}

}  // namespace
}  // namespace raygate
