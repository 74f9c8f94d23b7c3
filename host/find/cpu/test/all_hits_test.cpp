// All hits of a ray, against every triangle asked for itself in rationals.
#include "host/find/cpu/all_hits.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

using test::Random;
using Rational3 = std::array<mpq_class, 3>;

Rational3 minus(const glm::vec3& a, const glm::vec3& b) {
  Rational3 difference;
  for (int k = 0; k < 3; ++k) difference[k] = mpq_class(a[k]) - mpq_class(b[k]);
  return difference;
}

mpq_class determinant(const Rational3& a, const Rational3& b, const Rational3& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// The t of a hit in the inside of the triangle; nothing for a miss. On an edge the tilt of the ray
/// has the last word, which is hits_triangle's: `t` is then still rational.
std::optional<mpq_class> rational_hit(const Ray& ray, const Corners& triangle) {
  const Rational3 a = minus(triangle[0], ray.origin), b = minus(triangle[1], ray.origin),
                  c = minus(triangle[2], ray.origin), way = minus(ray.direction, glm::vec3(0.0f));
  const mpq_class sides[] = {determinant(way, a, b), determinant(way, b, c),
                             determinant(way, c, a)};
  const mpq_class volume = determinant(a, b, c), sum = sides[0] + sides[1] + sides[2];
  const auto has = [&](int sign) {
    return std::ranges::any_of(sides, [&](const mpq_class& side) { return sgn(side) == sign; });
  };
  if ((has(1) && has(-1)) || sgn(volume) == 0 || sgn(sum) == 0) return std::nullopt;
  const mpq_class t = volume / sum;
  if (sgn(t) <= 0 || (has(0) && !hits_triangle(ray, triangle))) return std::nullopt;
  return t;
}

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
    for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
      const auto t = rational_hit(ray, bvh.corners_of(slot));
      if (t && (limit == std::numeric_limits<float>::infinity() || *t < mpq_class(limit))) {
        expected.emplace_back(*t, bvh.triangle_of(slot));
      }
    }
    std::ranges::sort(expected);
    std::vector<NearestHit> hits;
    RayWork work;
    all_hits(bvh, ray, limit, hits, work);
    EXPECT_EQ(hits.size(), expected.size());
    for (std::size_t i = 0; i < std::min(hits.size(), expected.size()); ++i) {
      EXPECT_EQ(bvh.triangle_of(hits[i].slot), expected[i].second) << "hit " << i;
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
