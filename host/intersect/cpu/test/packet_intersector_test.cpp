// Tests in place find what batches find, P's bits included, and in exact arithmetic the nearest.
#include <gtest/gtest.h>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/test/compare_in_place.h"

namespace raygate {
namespace {

using test::Random;

/// A fan of rays, some aimed at vertices, edges and the like, then some that hit nothing at all.
std::vector<Ray> fan(Random& random, const std::vector<Corners>& mesh, const glm::vec3& origin,
                     const glm::vec3& middle, float width, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Corners& t = mesh[random.below(static_cast<int>(mesh.size()))];
    glm::dvec3 way = glm::dvec3(middle + random.point(width)) - glm::dvec3(origin);
    if (random.below(16) == 0) way = glm::dvec3(t[0]) - glm::dvec3(origin);
    if (random.below(16) == 0)
      way = 0.5 * (glm::dvec3(t[0]) + glm::dvec3(t[1])) - glm::dvec3(origin);
    if (random.below(32) == 0) way[random.below(3)] = 0.0;
    if (random.below(32) == 0) way[random.below(3)] *= 1e-40;
    if (way == glm::dvec3(0.0)) way = glm::dvec3(1.0, 0.0, 0.0);
    rays.push_back({origin, scaled_direction(way)});
  }
  rays.push_back({origin, glm::vec3(0.0f)});
  rays.push_back({origin, glm::vec3(std::numeric_limits<float>::infinity(), 1.0f, 0.0f)});
  rays.push_back({origin, glm::vec3(std::numeric_limits<float>::quiet_NaN(), 1.0f, 0.0f)});
  return rays;
}

class PacketIntersectorTest : public testing::Test {
 protected:
  /// Traces in place and in batches; returns the number of hits.
  int compare(const std::vector<Corners>& mesh, const std::vector<Ray>& rays, RayQuery query) {
    const Bvh bvh(test::scene_of(mesh));
    query.common_origin = true;
    const test::InPlace done = test::compare_in_place(bvh, rays, query);
    tests_ += done.counters.tests;
    return done.hits;
  }

  void try_mesh(const std::vector<Corners>& mesh, float size, int rounds) {
    int hits = 0;
    for (int round = 0; round < rounds; ++round) {
      const glm::vec3 origin = random_.point(2.0f * size), middle = random_.point(size);
      const float width = std::ldexp(size, -random_.below(12));
      const std::vector<Ray> rays =
          fan(random_, mesh, origin, middle, width, 1 + random_.below(300));
      hits += compare(mesh, rays, {});
      std::vector<float> limits;
      std::vector<std::uint32_t> ignored;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        limits.push_back(random_.below(3) == 0 ? std::numeric_limits<float>::infinity()
                                               : random_.uniform(0.01f, 3.0f));
        ignored.push_back(random_.below(2) == 0 ? NearestHit::kNone
                                                : static_cast<std::uint32_t>(random_.below(
                                                      static_cast<int>(mesh.size()))));
      }
      hits += compare(mesh, rays, {.t_max = limits});
      hits += compare(mesh, rays, {.t_max = limits, .skip_ids = ignored});
      hits += compare(mesh, rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = limits});
    }
    EXPECT_GT(hits, rounds);
    EXPECT_GT(tests_, static_cast<std::uint64_t>(hits));
  }

  Random random_;
  std::uint64_t tests_ = 0;  // of all that was compared
};

TEST_F(PacketIntersectorTest, FindsWhatBatchesFind) {
  try_mesh(test::sphere(3), 1.0f, 60);
  try_mesh(test::box(glm::vec3(-1), glm::vec3(1)), 1.0f, 60);
  std::vector<Corners> soup;
  for (int i = 0; i < 200; ++i) soup.push_back({random_.point(), random_.point(), random_.point()});
  try_mesh(soup, 1.0f, 60);
  std::vector<Corners> twice = soup;  // every hit is a tie
  twice.insert(twice.end(), soup.begin(), soup.end());
  try_mesh(twice, 1.0f, 20);
}

TEST_F(PacketIntersectorTest, FindsWhatBatchesFindAtAnyScale) {
  for (const float size : {1e-37f, 1e-30f, 1e-18f, 1e18f, 1e30f}) {
    std::vector<Corners> mesh = test::box(glm::vec3(-size), glm::vec3(size));
    for (int i = 0; i < 50; ++i) {
      mesh.push_back({random_.point(size), random_.point(size), random_.point(size)});
    }
    try_mesh(mesh, size, 10);
  }
}

}  // namespace
}  // namespace raygate
