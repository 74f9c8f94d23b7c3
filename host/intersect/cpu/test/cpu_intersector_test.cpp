// CpuIntersector finds the hits and points of the unit's reference model, in packets and ray by
// ray, for all instruction sets. Ties and limits are exact. all_hits() agrees with rationals.
#include "host/intersect/cpu/cpu_intersector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "host/base/test/using_vectors.h"
#include "host/exact/test/meshes.h"
#include "host/exact/test/rational_oracle.h"
#include "host/intersect/unit/test/model_intersector.h"

namespace raygate {
namespace {

using test::Random;

/// Parameter: whether all rays have a common origin (packets) or not (ray by ray).
class CpuIntersectorTest : public testing::TestWithParam<bool> {
 protected:
  const Corners& any(const std::vector<Corners>& mesh) {
    return mesh[random_.below(static_cast<int>(mesh.size()))];
  }

  /// Returns a random corner of the triangle, the middle of an edge, or the middle of the triangle.
  glm::dvec3 middle(const Corners& t) {
    const int corners = 1 + random_.below(3);
    glm::dvec3 sum(0.0);
    for (int v = 0; v < corners; ++v) sum += glm::dvec3(t[v]);
    return sum / static_cast<double>(corners);
  }

  /// Returns rays, some aimed at corners and edges; the last ones have unusable directions. Rays of
  /// a common origin are a fan of any width; others start anywhere, some at or nearly on triangles.
  std::vector<Ray> some_rays(const std::vector<Corners>& mesh, float size, int count) {
    const glm::vec3 eye = random_.point(2.0f * size), target = random_.point(size);
    const float width = GetParam() ? std::ldexp(size, -random_.below(12)) : size;
    std::vector<Ray> rays;
    while (static_cast<int>(rays.size()) < count) {
      glm::vec3 origin = GetParam() ? eye : random_.point(2.0f * size);
      if (!GetParam() && random_.below(2) == 0) origin = glm::vec3(middle(any(mesh)));
      glm::dvec3 way =
          glm::dvec3((GetParam() ? target : glm::vec3(0)) + random_.point(width) - origin);
      if (random_.below(GetParam() ? 8 : 2) == 0) way = middle(any(mesh)) - glm::dvec3(origin);
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
    for (const float x : {0.0f, infinity, infinity - infinity}) {
      rays.push_back({eye, glm::vec3(x, x == 0.0f ? 0.0f : 1.0f, 0.0f)});
    }
    return rays;
  }

  /// Expects the reference model's hits, the same bits with every instruction set, and consistent
  /// counts. Returns the number of hits.
  int compare(const Bvh& bvh, const std::vector<Ray>& rays, RayQuery query) {
    query.common_origin = GetParam();
    std::vector<NearestHit> expected(rays.size()), first;
    std::vector<RayWork> first_work;
    test::find(*test::model_intersector(bvh), rays, query, expected);
    int hits = 0;
    for (const Vectors vectors : machine_vectors()) {
      const UsingVectors in_use(vectors);
      std::vector<RayWork> work(rays.size());
      std::vector<NearestHit> found(rays.size());
      CpuIntersector intersector(bvh);
      query.work = work;
      test::find(intersector, rays, query, found);
      if (first.empty()) {
        first = found;
        first_work = work;
        hits = compare_with_model(query, found, expected);
        check_counts(intersector.counters().hit, work);
      }
      for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(found[i].primitive, first[i].primitive) << i << ", " << name_of(vectors);
        EXPECT_EQ(work[i].tests, first_work[i].tests) << i << ", " << name_of(vectors);
        EXPECT_EQ(work[i].doubts, first_work[i].doubts) << i << ", " << name_of(vectors);
        if (found[i].primitive == NearestHit::kNone) continue;
        EXPECT_EQ(found[i].t.low, first[i].t.low) << i << ", " << name_of(vectors);
        EXPECT_EQ(found[i].t.high, first[i].t.high) << i << ", " << name_of(vectors);
        if (test::with_points(query)) expect_same_points(found[i], first[i]);
      }
    }
    return hits;
  }

  static void expect_same_points(const NearestHit& a, const NearestHit& b) {
    EXPECT_EQ(std::memcmp(&a.point, &b.point, sizeof a.point), 0);
    EXPECT_EQ(a.point_error, b.point_error);
  }

  static int compare_with_model(const RayQuery& query, const std::vector<NearestHit>& found,
                                const std::vector<NearestHit>& expected) {
    int hits = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const NearestHit &a = found[i], &b = expected[i];
      const bool is_hit = a.primitive != NearestHit::kNone;
      hits += is_hit ? 1 : 0;
      if (!query.any_hit_before.empty()) {
        EXPECT_EQ(is_hit, b.primitive != NearestHit::kNone) << i;
        continue;
      }
      EXPECT_EQ(a.primitive, b.primitive) << i;
      if (is_hit && test::with_points(query)) expect_same_points(a, b);
      EXPECT_LE(a.t.low, b.t.high);
      EXPECT_GE(a.t.high, b.t.low);
    }
    return hits;
  }

  void check_counts(const HitCounters& counters, const std::vector<RayWork>& work) {
    tests_ += counters.tests;
    EXPECT_EQ(counters.tests, counters.misses + counters.hits + counters.edge_doubts);
    RayWork sum;
    for (const RayWork& ray : work) sum += ray;
    EXPECT_EQ(sum.tests, counters.tests);
    EXPECT_EQ(sum.doubts, counters.edge_doubts);
  }

  void try_mesh(const std::vector<Corners>& mesh, float size, int rounds) {
    const Bvh bvh(test::scene_of(mesh));
    int hits = 0;
    for (int round = 0; round < (GetParam() ? rounds : 1); ++round) {
      const std::vector<Ray> rays =
          some_rays(mesh, size, GetParam() ? 1 + random_.below(300) : 3000);
      std::vector<float> limits;
      std::vector<std::uint32_t> ignored;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        limits.push_back(random_.below(3) == 0 ? std::numeric_limits<float>::infinity()
                                               : random_.uniform(0.01f, 3.0f));
        ignored.push_back(random_.below(2) == 0 ? NearestHit::kNone
                                                : static_cast<std::uint32_t>(random_.below(
                                                      static_cast<int>(mesh.size()))));
      }
      hits += compare(bvh, rays, {});
      hits += compare(bvh, rays, {.t_max = limits});
      hits += compare(bvh, rays, {.t_max = limits, .skip_ids = ignored});
      hits += compare(bvh, rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = limits});
    }
    EXPECT_GT(hits, GetParam() ? rounds : 1000);
    EXPECT_GT(tests_, static_cast<std::uint64_t>(hits));
  }

  Random random_;
  std::uint64_t tests_ = 0;  // sum over all comparisons
};

INSTANTIATE_TEST_SUITE_P(CommonOrigin, CpuIntersectorTest, testing::Values(false, true));

TEST_P(CpuIntersectorTest, FindsWhatBatchesFind) {
  try_mesh(test::sphere(3), 1.0f, 60);
  try_mesh(test::box(glm::vec3(-1), glm::vec3(1)), 1.0f, 60);
  std::vector<Corners> soup;
  for (int i = 0; i < 200; ++i) soup.push_back({random_.point(), random_.point(), random_.point()});
  try_mesh(soup, 1.0f, 60);
  std::vector<Corners> twice = soup;  // every hit is a tie
  twice.insert(twice.end(), soup.begin(), soup.end());
  try_mesh(twice, 1.0f, 20);
}

TEST_P(CpuIntersectorTest, FindsWhatBatchesFindAtAnyScale) {
  for (const float size : {1e-37f, 1e-30f, 1e-18f, 1e-6f, 1e12f, 1e18f, 1e30f}) {
    std::vector<Corners> mesh = test::box(glm::vec3(-size), glm::vec3(size));
    for (int i = 0; i < 50; ++i) {
      mesh.push_back({random_.point(size), random_.point(size), random_.point(size)});
    }
    try_mesh(mesh, size, 10);
  }
}

// A hit at the limit does not count. Of two hits at equal t, the lower triangle index is reported.
TEST(CpuIntersector, LimitsAndTiesAreExact) {
  const Corners wall = {glm::vec3(-4, -4, 3), glm::vec3(4, -4, 3), glm::vec3(0, 4, 3)};
  const Bvh bvh(test::scene_of({wall, wall}));
  std::vector<NearestHit> hits(3);
  const std::vector<Ray> rays(3, {glm::vec3(0), glm::vec3(0.25f, 0.5f, 1)});
  const std::vector<float> limits = {std::nextafter(3.0f, 0.0f), 3.0f, std::nextafter(3.0f, 4.0f)};
  CpuIntersector(bvh).nearest(rays, {.t_max = limits}, hits);
  EXPECT_EQ(hits[0].primitive, NearestHit::kNone);
  EXPECT_EQ(hits[1].primitive, NearestHit::kNone);
  ASSERT_NE(hits[2].primitive, NearestHit::kNone);
  EXPECT_EQ(bvh.triangle_of(hits[2].primitive), 0u);
  EXPECT_EQ(hits[2].point, glm::vec3(0.75f, 1.5f, 3));
}

class AllHits : public testing::Test {
 protected:
  /// Compares some rays' hits in a mesh of about this `size`; returns the number of hits.
  std::size_t compare(const std::vector<Corners>& mesh, float size, int rays) {
    const Bvh bvh(test::scene_of(mesh));
    std::size_t count = 0;
    for (int i = 0; i < rays; ++i) {
      Ray ray{random_.point(1.5f * size), glm::vec3(0.0f)};
      const Corners& aim = mesh[random_.below(static_cast<int>(mesh.size()))];
      const int kind = random_.below(4);  // aim: a corner, an edge, an inside, anywhere
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
