// Nearest hits do not depend on the order of reports. CheckIntersector detects wrong hits.
#include "host/intersect/intersector.h"

#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "host/exact/test/meshes.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/test/model_intersector.h"

namespace raygate {
namespace {

/// A CpuIntersector whose hits `fault` modifies.
class FaultyIntersector : public CpuIntersector {
 public:
  using Fault = std::function<void(std::span<NearestHit>)>;
  FaultyIntersector(const Bvh& bvh, Fault fault) : CpuIntersector(bvh), fault_(std::move(fault)) {}

  void trace(std::span<const Ray> rays, const RayQuery& query,
             std::span<NearestHit> hits) override {
    CpuIntersector::trace(rays, query, hits);
    fault_(hits);
  }

 private:
  Fault fault_;
};

class CheckIntersectorTest : public testing::Test {
 protected:
  CheckIntersectorTest() {
    test::Random random;
    for (int i = 0; i < 100; ++i) {
      rays_.push_back({glm::vec3(0.25f), scaled_direction(glm::dvec3(random.point()))});
    }
  }

  /// Returns the message of CheckIntersector, or "" if the intersectors agree.
  std::string complaint(const FaultyIntersector::Fault& fault, const RayQuery& query) {
    CheckIntersector check(bvh_, std::make_unique<FaultyIntersector>(bvh_, fault),
                           test::model_intersector(bvh_));
    std::vector<NearestHit> hits(rays_.size());
    try {
      test::find(check, rays_, query, hits);
    } catch (const EngineMismatch& mismatch) {
      return mismatch.what();
    }
    return "";
  }

  Bvh bvh_{test::scene_of(test::sphere(2))};
  std::vector<Ray> rays_;
};

TEST_F(CheckIntersectorTest, IntersectorsThatAgreePass) {
  for (const bool common : {false, true}) {
    EXPECT_EQ(complaint([](auto) {}, {.common_origin = common}), "");
  }
  const std::vector<float> limits(rays_.size(), 0.9f);
  EXPECT_EQ(complaint([](auto) {}, {.t_max = limits, .any_hit_before = limits}), "");
}

TEST_F(CheckIntersectorTest, OneBitOfPIsThrownWithTheRay) {
  const std::string what = complaint(
      [](std::span<NearestHit> hits) {
        float& y = hits[7].point.y;
        y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(y) ^ 1);
      },
      {});
  EXPECT_NE(what.find("ray 3E800000 3E800000 3E800000, "), std::string::npos) << what;
  EXPECT_NE(what.find("limit 7F800000: triangle "), std::string::npos) << what;
  EXPECT_NE(what.find("; reference: triangle "), std::string::npos) << what;
}

TEST_F(CheckIntersectorTest, AnotherTriangleOrDistanceOrNoHitIsThrown) {
  EXPECT_NE(complaint([](auto hits) { hits[3].primitive ^= 1; }, {}), "");
  EXPECT_NE(complaint([](auto hits) { hits[3].primitive = NearestHit::kNone; }, {}), "");
  EXPECT_NE(complaint([](auto hits) { hits[3].t = {2.0, 2.0}; }, {}), "");
}

// Different hits are accepted if both are nearer than any_hit_before.
TEST_F(CheckIntersectorTest, OfRaysThatMayEndAnywhereTheAnswerIsWhetherThereIsAHit) {
  const std::vector<float> enough(rays_.size(), 100.0f), little(rays_.size(), 0.01f);
  const auto other = [](auto hits) { hits[3].primitive ^= 1; };
  EXPECT_EQ(complaint(other, {.any_hit_before = enough}), "");
  EXPECT_NE(complaint(other, {.any_hit_before = little}), "");
  EXPECT_NE(complaint([](auto hits) { hits[3] = {}; }, {.any_hit_before = enough}), "");
}

// Cones could miss hits of unscaled directions, so every intersector refuses them.
TEST_F(CheckIntersectorTest, UnscaledDirectionsAreRefused) {
  CpuIntersector cpu(bvh_);
  const auto unit = test::model_intersector(bvh_);
  std::vector<NearestHit> hits(rays_.size());
  for (const float scale : {0x1p20f, 2.0f, 0.5f, 0x1p-20f}) {
    std::vector<Ray> rays = rays_;
    rays[41].direction *= scale;
    for (const bool common : {false, true}) {
      EXPECT_THROW(cpu.nearest(rays, {.common_origin = common}, hits), std::invalid_argument);
      EXPECT_THROW(unit->nearest(rays, {.common_origin = common}, hits), std::invalid_argument);
    }
  }
}

const Ray kRay = {glm::vec3(0), glm::vec3(0, 0, 1)};

Corners at_depth(float z) {
  return {glm::vec3(-1, -1, z), glm::vec3(1, -1, z), glm::vec3(0, 1, z)};
}

/// Returns a hit whose interval of t is too wide to decide any comparison.
NearestHit hit_of(std::uint32_t primitive) { return {.primitive = primitive, .t = {0.0, 10.0}}; }

// Five triangles: two nearest ones at the same depth, two an ulp farther, one far behind. They are
// reported in every order, as hits whose intervals decide nothing and as doubts.
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
        take_if_nearest(bvh, kRay, INFINITY, hit_of(primitive), kind == 0, best, counters);
      }
      ASSERT_EQ(bvh.triangle_of(best.primitive), 2u);
    }
  } while (std::ranges::next_permutation(primitives).found);
  // A doubt is not resolved if it is surely farther than a known hit. Over all 120 orders, each of
  // the two nearest is always resolved; each of the two an ulp farther is resolved if it comes
  // before both nearest ones (40 orders); the farthest is resolved if it comes first (24 orders).
  EXPECT_EQ(counters.exact_inside, 2u * 120 + 2u * 40 + 24);
  EXPECT_GT(counters.exact_depth, 0u);
}

// The limit is exclusive and exact: a hit one ulp before it counts, a hit at the limit does not,
// whatever the interval of t.
TEST(NearestHit, NothingAtOrBeyondTheLimitCounts) {
  const float limit = 0.7f, before = std::nextafter(limit, 0.0f);
  const Bvh bvh(test::scene_of({at_depth(before), at_depth(limit)}));
  IntersectCounters counters;
  for (std::uint32_t primitive = 0; primitive < 2; ++primitive) {
    const bool expected = bvh.corners_of(primitive)[0].z < limit;
    for (const bool is_sure : {true, false}) {
      NearestHit best;
      EXPECT_EQ(take_if_nearest(bvh, kRay, limit, hit_of(primitive), is_sure, best, counters),
                expected);
    }
  }
}

TEST(NearestHit, ADoubtThatIsAMissLeavesNothing) {
  const Bvh bvh(test::scene_of({at_depth(-1)}));
  IntersectCounters counters;
  NearestHit best;
  EXPECT_FALSE(take_if_nearest(bvh, kRay, INFINITY, {.primitive = 0}, false, best, counters));
  EXPECT_EQ(best.primitive, NearestHit::kNone);
}

}  // namespace
}  // namespace raygate
