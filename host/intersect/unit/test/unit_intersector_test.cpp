// Rays of any origins find the hits of an exact test of every triangle.
#include <gtest/gtest.h>

#include <memory>

#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/unit/test/model_intersector.h"

namespace raygate {
namespace {

using test::Random;
using test::some_rays;

std::uint32_t exact_nearest(const Bvh& bvh, const Ray& ray, float limit,
                            std::uint32_t ignored = NearestHit::kNone) {
  std::uint32_t best = NearestHit::kNone;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    const Corners& t = bvh.corners_of(primitive);
    if (primitive == ignored || !hits_triangle(ray, t)) continue;
    if (std::isfinite(limit) && compare_hit_to_limit(ray, t, limit) >= 0) continue;
    const int order = best == NearestHit::kNone ? -1 : compare_hits(ray, t, bvh.corners_of(best));
    if (order < 0 || (order == 0 && bvh.triangle_of(primitive) < bvh.triangle_of(best)))
      best = primitive;
  }
  return best;
}

class UnitIntersectorTest : public testing::Test {
 protected:
  std::vector<Corners> mesh_ = test::bodies();
  Bvh bvh_{test::scene_of(mesh_)};
  std::unique_ptr<Intersector> intersector_ = test::model_intersector(bvh_);
  Random random_;

  std::vector<NearestHit> find(const std::vector<Ray>& rays, const RayQuery& query = {}) {
    std::vector<NearestHit> hits(rays.size());
    test::find(*intersector_, rays, query, hits);
    return hits;
  }
};

TEST_F(UnitIntersectorTest, OwnOriginsFindTheExactNearest) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 3000);
  std::vector<float> limits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    limits.push_back(i % 2 == 0 ? std::numeric_limits<float>::infinity()
                                : random_.uniform(0.01f, 3.0f));
  }
  const auto hits_found = find(rays, {.t_max = limits});
  int hits = 0, misses = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t expected = exact_nearest(bvh_, rays[i], limits[i]);
    ASSERT_EQ(hits_found[i].primitive, expected) << i;
    ++(expected == NearestHit::kNone ? misses : hits);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 100);
  EXPECT_GT(intersector_->counters().exact_inside, 0u);
  EXPECT_GT(intersector_->counters().records, 0u);
}

TEST_F(UnitIntersectorTest, TheWorkOfEachRayIsCounted) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 300);
  std::vector<RayWork> work(rays.size());
  (void)find(rays, {.work = work});
  std::uint64_t tests = 0;
  for (const RayWork& ray : work) {
    EXPECT_LT(ray.tests, mesh_.size() / 2);
    tests += ray.tests;
  }
  EXPECT_EQ(tests, intersector_->counters().hit.tests);
}

// A ray ends early if any hit is nearer than any_hit_before; otherwise it finds its nearest hit.
TEST_F(UnitIntersectorTest, RaysEndAtAnyHitThatWillDo) {
  std::vector<Ray> rays = some_rays(mesh_, random_, 1000);
  std::vector<float> enough;
  for (Ray& ray : rays) {
    ray.origin *= 10.0f;  // outside, so that there are several hits
    ray.direction = scaled_direction(glm::dvec3(random_.point(2.0f) - ray.origin));
    enough.push_back(random_.below(4) == 0 ? INFINITY : random_.uniform(2.0f, 20.0f));
  }
  const auto hits = find(rays, {.any_hit_before = enough});
  int ended = 0, farther = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t exact = exact_nearest(bvh_, rays[i], INFINITY);
    const std::uint32_t found = hits[i].primitive;
    ASSERT_EQ(exact == NearestHit::kNone, found == NearestHit::kNone);
    if (found == NearestHit::kNone) continue;
    const bool is_before = raygate::is_before(bvh_, rays[i], hits[i], enough[i]);
    ASSERT_EQ(is_before, exact_nearest(bvh_, rays[i], enough[i]) != NearestHit::kNone);
    ASSERT_TRUE(is_before || found == exact);
    ++(is_before ? ended : farther);
  }
  EXPECT_GT(ended, 100);
  EXPECT_GT(farther, 100);
  EXPECT_EQ(intersector_->counters().ended_early, static_cast<std::uint64_t>(ended));
}

// This includes bursts whose ignored hit hides a farther hit of the same leaf.
TEST_F(UnitIntersectorTest, IgnoredSlotsDoNotCount) {
  std::vector<Ray> rays = some_rays(mesh_, random_, 1000);
  for (Ray& ray : rays) {
    ray.origin *= 10.0f;  // outside: rays meet both sides of the sphere and of the box
    ray.direction = scaled_direction(glm::dvec3(random_.point(1.5f) - ray.origin));
  }
  std::vector<std::uint32_t> ignored;
  for (const NearestHit& hit : find(rays)) ignored.push_back(hit.primitive);
  const auto others = find(rays, {.skip_ids = ignored});
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t found = others[i].primitive;
    ASSERT_EQ(found, exact_nearest(bvh_, rays[i], INFINITY, ignored[i]));
    hits += found != NearestHit::kNone;
  }
  EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace raygate
