// The words of a record, and the bound that makes its sure answers sure.
#include "host/intersect/polygon_record.h"

#include <gtest/gtest.h>

#include "host/exact/expansion.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

using test::float_dot;
using test::Random;

TEST(PolygonRecord, IsWhatThePaperSays) {
  const PolygonRecord record =
      make_record(glm::vec3(1, 0, 0), {glm::vec3(1, 1, 2), glm::vec3(3, 1, 2), glm::vec3(1, 4, 2)});
  EXPECT_EQ(record.normal, glm::vec3(0, 0, 6));
  EXPECT_EQ(record.d, 12.0f);
  EXPECT_EQ(record.edges[0], glm::cross(glm::vec3(0, 1, 2), glm::vec3(2, 1, 2)));
  EXPECT_EQ(record.edges[1], glm::cross(glm::vec3(2, 1, 2), glm::vec3(0, 4, 2)));
  EXPECT_EQ(record.edges[2], glm::cross(glm::vec3(0, 4, 2), glm::vec3(0, 1, 2)));
}

TEST(PolygonRecord, NeighboursHoldOppositeEdges) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 o = random.point(), a = random.point(), b = random.point();
    const PolygonRecord left = make_record(o, {a, b, random.point()});
    const PolygonRecord right = make_record(o, {b, a, random.point()});
    ASSERT_EQ(left.edges[0], -right.edges[0]);
    ASSERT_EQ(left.bounds[0], right.bounds[0]);
  }
}

// Tries to break the bound: the float sum against the exact one, on random directions and on those
// that nearly cancel, where all three roundings happen at the size of the terms.
TEST(PolygonRecord, BoundHolds) {
  Random random;
  double worst = 0.0;
  long tests = 0;
  for (int i = 0; i < 300000; ++i) {
    const float far = i % 2 == 0 ? 0.0f : 1000.0f;
    const glm::vec3 o = random.point(), a = random.point() + far;
    const glm::vec3 b = i % 3 == 0 ? a + random.point(1e-4f) : random.point() + far;
    const PolygonRecord record = make_record(o, {a, b, random.point()});
    if (a == b) continue;
    const auto exact = exact_cross(exact_difference(a, o), exact_difference(b, a));
    for (int k = 0; k < 10; ++k) {
      const glm::dvec3 aim = glm::mix(glm::dvec3(a), glm::dvec3(b), random.uniform()) -
                             glm::dvec3(o) + glm::dvec3(random.point(k == 0 ? 1.0f : 1e-7f));
      const glm::vec3 direction = scaled_direction(aim);
      const float u = float_dot(direction, record.edges[0]);
      const auto off = exact_dot(direction, exact) - exact_difference(u, 0.0);
      const auto bound = exact_difference(record.bounds[0], 0.0);
      ASSERT_LT((off - bound).sign(), 0);
      ASSERT_GT((off + bound).sign(), 0);
      worst = std::max(worst, std::abs(off.approximate()) / record.bounds[0]);
      ++tests;
    }
  }
  std::cout << tests << " tests, worst error " << worst << " of the bound\n";
  EXPECT_GT(worst, 0.1);  // the query does reach the neighbourhood of the bound
}

// Sure signs are right at every scale, the ones at which unscaled words would leave float's range
// too.
TEST(PolygonRecord, SureSignsAreRightAtEveryScale) {
  Random random;
  long sure = 0;
  for (int i = 0; i < 200000; ++i) {
    const float size = std::ldexp(1.0f, random.below(251) - 125);
    const glm::vec3 o = random.point(size);
    const Corners t = {random.point(size), random.point(size), random.point(size)};
    const PolygonRecord record = make_record(o, t);
    ASSERT_EQ(orient3d(o, t), (record.d > 0) - (record.d < 0));
    const glm::dvec3 aim =
        glm::mix(glm::dvec3(t[0]), glm::dvec3(t[1]), random.uniform(0, 1)) - glm::dvec3(o);
    const Ray ray = {o, scaled_direction(aim + 1e-6 * glm::dvec3(random.point(size)))};
    for (int k = 0; k < 3; ++k) {
      const float u = float_dot(ray.direction, record.edges[k]);
      ASSERT_FALSE(std::isnan(u));
      if (std::abs(u) <= record.bounds[k]) continue;
      ASSERT_EQ(edge_side(ray, t[k], t[(k + 1) % 3]), u > 0 ? 1 : -1) << "size " << size;
      ++sure;
    }
  }
  EXPECT_GT(sure, 300000);
}

// Numbers that no loader lets in: nothing is sure of them, and nothing undefined happens.
TEST(PolygonRecord, WhatIsNotFiniteLeavesADoubt) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {infinity, -infinity, infinity - infinity}) {
    for (int word = 0; word < 12; ++word) {
      glm::vec3 points[4] = {{0, 0, 0}, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};  // origin and corners
      points[word / 3][word % 3] = bad;
      const Corners corners = {points[1], points[2], points[3]};
      const PolygonRecord record = make_record(points[0], corners);
      for (const glm::vec3& way : {glm::vec3(0, 0, 1), glm::vec3(0.2f, -0.1f, 1)}) {
        EXPECT_EQ(ReferenceBurstUnit().verdict(record, way), UnitVerdict::kDoubt) << word;
      }
    }
  }
}

TEST(PolygonRecord, NoAreaOrOriginInThePlaneHasNoDistance) {
  const glm::vec3 a(1, 2, 3), b(4, 5, 6), c(0, 1, 0);
  EXPECT_EQ(make_record(glm::vec3(0.3f), {a, a, b}).d, 0.0f);
  EXPECT_EQ(make_record(a, {a, b, c}).d, 0.0f);
}

}  // namespace
}  // namespace raygate
