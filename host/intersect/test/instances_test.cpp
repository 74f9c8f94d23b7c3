// Rays find the same hits with instances as with the same triangles written out.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "host/base/test/using_vectors.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/test/model_intersector.h"
#include "host/scene/test/instanced_scene.h"

namespace raygate {
namespace {

using test::Random;

class InstancesTest : public testing::Test {
 protected:
  Random random_;
  Scene scene_ = test::instanced_scene(random_, 30), flat_ = test::written_out(scene_);
  Bvh bvh_{scene_}, flat_bvh_{flat_};

  /// Returns rays, many through vertices, from `origin` or, if null, from different origins.
  std::vector<Ray> rays(int count, const glm::vec3* origin) {
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < count) {
      const glm::vec3 from = origin != nullptr ? *origin : random_.point(3.5f);
      const glm::dvec3 aim(
          random_.below(2) == 0
              ? flat_.positions[random_.below(static_cast<int>(flat_.positions.size()))]
              : random_.point(3.5f));
      if (aim != glm::dvec3(from)) rays.push_back({from, scaled_direction(aim - glm::dvec3(from))});
    }
    return rays;
  }

  void expect_same(Intersector& intersector, Intersector& flat_intersector,
                   const std::vector<Ray>& rays, const RayQuery& query) {
    std::vector<NearestHit> hits(rays.size()), expected(rays.size());
    test::find(intersector, rays, query, hits);
    test::find(flat_intersector, rays, query, expected);
    std::size_t instances = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const NearestHit &hit = hits[i], &other = expected[i];
      ASSERT_EQ(hit.primitive == NearestHit::kNone, other.primitive == NearestHit::kNone) << i;
      if (hit.primitive == NearestHit::kNone) continue;
      ASSERT_EQ(bvh_.triangle_of(hit.primitive), flat_bvh_.triangle_of(other.primitive)) << i;
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(hit.point[k]),
                  std::bit_cast<std::uint32_t>(other.point[k]));
      }
      ASSERT_EQ(hit.point_error, other.point_error);
      ASSERT_TRUE(hit.t.low <= other.t.high && other.t.low <= hit.t.high);
      instances += bvh_.is_instanced(hit.primitive) ? 1 : 0;
    }
    EXPECT_GT(instances, rays.size() / 8);
  }

  void expect_same(Intersector& intersector, Intersector& flat_intersector) {
    constexpr int kCount = 4000;
    expect_same(intersector, flat_intersector, rays(kCount, nullptr), {});
    const glm::vec3 eye = random_.point(3.5f);
    expect_same(intersector, flat_intersector, rays(kCount, &eye), {.common_origin = true});
    std::vector<float> limits;
    for (int i = 0; i < kCount; ++i) limits.push_back(random_.uniform(1.0f, 8.0f));
    expect_same(intersector, flat_intersector, rays(kCount, nullptr), {.t_max = limits});
  }
};

TEST_F(InstancesTest, RaysTestedInPlace) {
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors using_vectors(vectors);
    CpuIntersector intersector(bvh_), flat(flat_bvh_);
    expect_same(intersector, flat);
  }
}

TEST_F(InstancesTest, RaysTestedByTheUnit) {
  const auto intersector = test::model_intersector(bvh_), flat = test::model_intersector(flat_bvh_);
  expect_same(*intersector, *flat);
}

TEST_F(InstancesTest, AllHits) {
  std::vector<NearestHit> hits, expected;
  RayWork work;
  std::size_t found = 0;
  for (const Ray& ray : rays(1000, nullptr)) {
    constexpr float kNoLimit = std::numeric_limits<float>::infinity();
    all_hits(bvh_, ray, kNoLimit, hits, work);
    all_hits(flat_bvh_, ray, kNoLimit, expected, work);
    ASSERT_EQ(hits.size(), expected.size());
    for (std::size_t i = 0; i < hits.size(); ++i, ++found) {
      ASSERT_EQ(bvh_.triangle_of(hits[i].primitive), flat_bvh_.triangle_of(expected[i].primitive));
    }
  }
  EXPECT_GT(found, 3000u);
}

}  // namespace
}  // namespace raygate
