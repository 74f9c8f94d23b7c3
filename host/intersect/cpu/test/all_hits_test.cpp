// All hits of a ray, against every triangle asked for itself in rationals.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "host/exact/test/meshes.h"
#include "host/exact/test/rational_oracle.h"
#include "host/intersect/cpu/cpu_intersector.h"

namespace raygate {
namespace {

using test::Random;
class AllHits : public testing::Test {
 protected:
  /// Compares some rays through a mesh of about that size; returns the number of hits.
  std::size_t compare(const std::vector<Corners>& mesh, float size, int rays) {
    const Bvh bvh(test::scene_of(mesh));
    std::size_t count = 0;
    for (int i = 0; i < rays; ++i) {
      Ray ray{random_.point(1.5f * size), glm::vec3(0.0f)};
      const Corners& aim = mesh[random_.below(static_cast<int>(mesh.size()))];
      const int kind = random_.below(4);  // at a corner, an edge, an inside, anywhere
      glm::dvec3 target(0.0);
      for (int v = 0; v <= std::min(kind, 2); ++v) {
        target += glm::dvec3(aim[v]) / (std::min(kind, 2) + 1.0);
      }
      if (kind == 3) target = glm::dvec3(random_.point(size));
      const glm::dvec3 way = target - glm::dvec3(ray.origin);
      if (way == glm::dvec3(0.0)) continue;
      ray.direction = scaled_direction(way);
      const float limit = random_.below(2) == 0 ? std::numeric_limits<float>::infinity()
                                                : random_.uniform(0.1f, 3.0f * size);
      count += compare_one(bvh, ray, limit);
    }
    return count;
  }

  Random random_;

 private:
  static std::size_t compare_one(const Bvh& bvh, const Ray& ray, float limit) {
    std::vector<std::pair<mpq_class, std::uint32_t>> expected;
    for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
      const test::RationalOracle truth(ray, bvh.corners_of(primitive));
      if (!truth.hit()) continue;
      if (limit == std::numeric_limits<float>::infinity() || truth.t() < mpq_class(limit)) {
        expected.emplace_back(truth.t(), bvh.triangle_of(primitive));
      }
    }
    std::ranges::sort(expected);
    std::vector<NearestHit> hits;
    RayWork work;
    all_hits(bvh, ray, limit, hits, work);
    EXPECT_EQ(hits.size(), expected.size());
    for (std::size_t i = 0; i < std::min(hits.size(), expected.size()); ++i) {
      EXPECT_EQ(bvh.triangle_of(hits[i].primitive), expected[i].second) << "hit " << i;
      EXPECT_LE(mpq_class(hits[i].t.low), expected[i].first);
      EXPECT_GE(mpq_class(hits[i].t.high), expected[i].first);
    }
    return hits.size();
  }
};

TEST_F(AllHits, AreThoseOfRationalsInTheirOrder) {
  EXPECT_GT(compare(test::sphere(2, 1.0f), 1.0f, 400), 300u);
  EXPECT_GT(compare(test::sphere(2, 1.0f, glm::vec3(1000.0f, 0.0f, 0.0f)), 1000.0f, 400), 200u);
}

TEST_F(AllHits, EquallyFarOnesComeByTheirNumber) {
  std::vector<Corners> mesh;
  for (int i = 0; i < 40; ++i) {  // four sheets, ten times each
    const float z = static_cast<float>(i % 4);
    mesh.push_back(
        {glm::vec3(-4.0f, -4.0f, z), glm::vec3(4.0f, -4.0f, z), glm::vec3(0.0f, 4.0f, z)});
  }
  EXPECT_GT(compare(mesh, 3.0f, 200), 400u);
}

TEST_F(AllHits, NothingForARayThatGoesNowhere) {
  const Bvh bvh(test::scene_of(test::sphere(1, 1.0f)));
  std::vector<NearestHit> hits(3);
  RayWork work;
  all_hits(bvh, {}, std::numeric_limits<float>::infinity(), hits, work);
  EXPECT_TRUE(hits.empty());
  EXPECT_THROW(all_hits(bvh, {glm::vec3(0.0f), glm::vec3(8.0f, 0.0f, 0.0f)}, 1.0f, hits, work),
               std::invalid_argument);
}

}  // namespace
}  // namespace raygate
