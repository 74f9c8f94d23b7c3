// Rays one by one find what batches find, P's bits included, and in exact arithmetic the nearest.
#include <gtest/gtest.h>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/test/compare_in_place.h"

namespace raygate {
namespace {

using test::Random;

class SingleRayIntersectorTest : public testing::Test {
 protected:
  /// From anywhere, some from corners or nearly on triangles; some aimed at corners and edges; then
  /// some that hit nothing at all.
  std::vector<Ray> some_rays(const std::vector<Corners>& mesh, float size, int count) {
    const auto any = [&]() -> const Corners& {
      return mesh[random_.below(static_cast<int>(mesh.size()))];
    };
    const auto middle = [](const Corners& t, int corners) {
      glm::dvec3 sum(0.0);
      for (int v = 0; v < corners; ++v) sum += glm::dvec3(t[v]);
      return sum / static_cast<double>(corners);
    };
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < count) {
      glm::vec3 origin = random_.point(2.0f * size);
      if (random_.below(2) == 0) origin = glm::vec3(middle(any(), 1 + random_.below(3)));
      glm::dvec3 way = glm::dvec3(random_.point(size)) - glm::dvec3(origin);
      if (random_.below(2) == 0) way = middle(any(), 1 + random_.below(3)) - glm::dvec3(origin);
      if (random_.below(32) == 0) way[random_.below(3)] = 0.0;
      if (random_.below(32) == 0) way[random_.below(3)] *= 1e-40;
      if (way == glm::dvec3(0.0)) way = glm::dvec3(1.0, 0.0, 0.0);
      rays.push_back({origin, scaled_direction(way)});
      for (int k = 0; k < 3; ++k) {  // zeros of either sign
        float& component = rays.back().direction[k];
        if (component == 0.0f && random_.below(2) == 0) component = -0.0f;
      }
    }
    const float infinity = std::numeric_limits<float>::infinity();
    rays.push_back({glm::vec3(0.0f), glm::vec3(0.0f)});
    rays.push_back({glm::vec3(0.0f), glm::vec3(infinity, 1.0f, 0.0f)});
    rays.push_back({glm::vec3(0.0f), glm::vec3(infinity - infinity, 1.0f, 0.0f)});
    return rays;
  }

  /// Traces one by one and in batches; returns the number of hits.
  int compare(const Bvh& bvh, const std::vector<Ray>& rays, const RayQuery& query) {
    const test::InPlace done = test::compare_in_place(bvh, rays, query);
    EXPECT_GT(done.counters.tests, 0u);
    return done.hits;
  }

  void try_mesh(const std::vector<Corners>& mesh, float size) {
    const Bvh bvh(test::scene_of(mesh));
    const std::vector<Ray> rays = some_rays(mesh, size, 3000);
    int hits = compare(bvh, rays, {});
    std::vector<float> limits;
    std::vector<std::uint32_t> ignored;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      limits.push_back(random_.below(3) == 0 ? std::numeric_limits<float>::infinity()
                                             : random_.uniform(0.01f, 3.0f));
      ignored.push_back(random_.below(2) == 0 ? NearestHit::kNone
                                              : static_cast<std::uint32_t>(
                                                    random_.below(static_cast<int>(mesh.size()))));
    }
    hits += compare(bvh, rays, {.t_max = limits});
    hits += compare(bvh, rays, {.t_max = limits, .culling = false});
    hits += compare(bvh, rays, {.t_max = limits, .skip_ids = ignored});
    hits += compare(bvh, rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = limits});
    EXPECT_GT(hits, 1000);
  }

  Random random_;
};

TEST_F(SingleRayIntersectorTest, FindsWhatBatchesFind) {
  try_mesh(test::sphere(3), 1.0f);
  try_mesh(test::box(glm::vec3(-1), glm::vec3(1)), 1.0f);
  std::vector<Corners> soup;
  for (int i = 0; i < 200; ++i) soup.push_back({random_.point(), random_.point(), random_.point()});
  try_mesh(soup, 1.0f);
  std::vector<Corners> twice = soup;  // every hit is a tie
  twice.insert(twice.end(), soup.begin(), soup.end());
  try_mesh(twice, 1.0f);
}

TEST_F(SingleRayIntersectorTest, FindsWhatBatchesFindAtAnyScale) {
  for (const float size : {1e-37f, 1e-30f, 1e-6f, 1e12f, 1e18f, 1e30f}) {
    std::vector<Corners> mesh = test::box(glm::vec3(-size), glm::vec3(size));
    for (int i = 0; i < 50; ++i) {
      mesh.push_back({random_.point(size), random_.point(size), random_.point(size)});
    }
    try_mesh(mesh, size);
  }
}

// Rays that hit at exactly their limit do not hit, and those that hit two triangles at once hit the
// lower one.
TEST_F(SingleRayIntersectorTest, LimitsAndTiesAreExact) {
  const Corners wall = {glm::vec3(-4, -4, 3), glm::vec3(4, -4, 3), glm::vec3(0, 4, 3)};
  const Bvh bvh(test::scene_of({wall, wall}));
  CpuIntersector intersector(bvh);
  std::vector<NearestHit> hits(3);
  const std::vector<Ray> rays(3, {glm::vec3(0), glm::vec3(0.25f, 0.5f, 1)});
  const float past = std::nextafter(3.0f, 4.0f);
  const std::vector<float> limits = {std::nextafter(3.0f, 0.0f), 3.0f, past};
  intersector.intersect(rays, {.t_max = limits}, hits);
  EXPECT_EQ(hits[0].primitive, NearestHit::kNone);
  EXPECT_EQ(hits[1].primitive, NearestHit::kNone);
  ASSERT_NE(hits[2].primitive, NearestHit::kNone);
  EXPECT_EQ(bvh.triangle_of(hits[2].primitive), 0u);
  EXPECT_EQ(hits[2].point, glm::vec3(0.75f, 1.5f, 3));
}

}  // namespace
}  // namespace raygate
