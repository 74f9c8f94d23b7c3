// What a record made in binary32 promises: sure answers are right, and t is as near as it says.
#include "host/intersect/core/set_up.h"

#include <gtest/gtest.h>

#include "host/exact/expansion.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

using test::float_dot;
using test::Random;

/// A triangle and an origin: of any shape, or a sliver, far away, or with an origin near its plane.
struct View {
  glm::vec3 origin;
  Corners triangle;
};

View any_view(Random& random, int kind) {
  const float far = kind % 2 == 0 ? 0.0f : 1000.0f;
  View view{random.point(), {}};
  for (glm::vec3& corner : view.triangle) corner = random.point() + far;
  Corners& t = view.triangle;
  if (kind / 2 % 3 == 1) t[2] = glm::mix(t[0], t[1], random.uniform()) + random.point(0x1p-9f);
  if (kind / 6 % 3 == 1) {  // in the plane, but for roundings and a little more
    view.origin = t[0] + (t[1] - t[0]) * random.uniform(-2, 2) +
                  (t[2] - t[0]) * random.uniform(-2, 2) +
                  random.point(std::ldexp(1.0f, -random.below(24)));
  }
  return view;
}

/// From the origin through the triangle, or past an edge of it as near as floats get.
Ray aimed(Random& random, const View& view) {
  const Corners& t = view.triangle;
  const double u = random.uniform(0, 1), v = random.below(2) == 0 ? 0.0 : random.uniform(0, 1);
  const glm::dvec3 inside =
      glm::mix(glm::mix(glm::dvec3(t[0]), glm::dvec3(t[1]), u), glm::dvec3(t[2]), v);
  const glm::dvec3 aim = inside - glm::dvec3(view.origin);
  const auto off = glm::dvec3(random.point()) * std::ldexp(largest(aim), -random.below(26));
  const glm::vec3 direction = scaled_direction(aim + off);
  return {view.origin, direction};
}

TEST(SetUp, IsWhatThePaperSays) {
  const SetUpRecord made =
      set_up(glm::vec3(1, 0, 0), {glm::vec3(1, 1, 2), glm::vec3(3, 1, 2), glm::vec3(1, 4, 2)});
  EXPECT_EQ(made.record.normal, glm::vec3(0, 0, 6));
  EXPECT_EQ(made.record.d, 12.0f);
  EXPECT_EQ(made.record.edges[0], glm::cross(glm::vec3(0, 1, 2), glm::vec3(2, 1, 2)));
  EXPECT_EQ(made.record.edges[1], glm::cross(glm::vec3(2, 1, 2), glm::vec3(0, 4, 2)));
  EXPECT_EQ(made.record.edges[2], glm::cross(glm::vec3(0, 4, 2), glm::vec3(0, 1, 2)));
  EXPECT_EQ(made.normal_error, 0u);
}

// Tries to break the bound: the float sum against the exact one.
TEST(SetUp, BoundHolds) {
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 200000; ++i) {
    const View view = any_view(random, i);
    const auto& [a, b, c] = view.triangle;
    if (a == b) continue;
    const PolygonRecord record = set_up(view.origin, view.triangle).record;
    const auto exact = exact_cross(exact_difference(a, view.origin), exact_difference(b, a));
    for (int k = 0; k < 8; ++k) {
      const glm::vec3 direction = aimed(random, view).direction;
      const float u = float_dot(direction, record.edges[0]);
      const auto off = exact_dot(direction, exact) - exact_difference(u, 0.0);
      const auto bound = exact_difference(record.bounds[0], 0.0);
      ASSERT_LT((off - bound).sign(), 0);
      ASSERT_GT((off + bound).sign(), 0);
      worst = std::max(worst, std::abs(off.approximate()) / record.bounds[0]);
    }
  }
  std::cout << "worst error " << worst << " of the bound\n";
  EXPECT_GT(worst, 0.1);  // the query does reach the neighbourhood of the bound
}

TEST(SetUp, SureAnswersAreRightAtEveryScale) {
  Random random;
  const ReferenceBurstUnit unit;
  long counts[3] = {}, host_doubts = 0, of_known_d = 0;
  for (int i = 0; i < 400000; ++i) {
    const float size = i % 4 == 0 ? std::ldexp(1.0f, random.below(241) - 125) : 1.0f;
    View view = any_view(random, i);
    view.origin *= size;
    for (glm::vec3& corner : view.triangle) corner *= size;
    const SetUpRecord made = set_up(view.origin, view.triangle);
    if (!std::isnan(made.record.d)) {
      ASSERT_EQ(orient3d(view.origin, view.triangle), made.record.d > 0 ? 1 : -1) << i;
      ++of_known_d;
    }
    const PolygonRecord host_record = make_record(view.origin, view.triangle);
    for (int k = 0; k < 4; ++k) {
      const Ray ray = aimed(random, view);
      if (!is_usable(ray.direction)) continue;
      const UnitVerdict verdict = unit.verdict(made.record, ray.direction);
      ++counts[static_cast<int>(verdict)];
      host_doubts += unit.verdict(host_record, ray.direction) == UnitVerdict::kDoubt;
      if (verdict == UnitVerdict::kDoubt) continue;
      ASSERT_EQ(hits_triangle(ray, view.triangle), verdict == UnitVerdict::kHit) << i;
    }
  }
  std::cout << counts[0] << " misses, " << counts[1] << " hits, " << counts[2] << " doubts ("
            << host_doubts << " by a record made in double)\n";
  for (const long count : counts) EXPECT_GT(count, 100000);
  EXPECT_GT(of_known_d, 100000);
}

/// How many floats lie between t and the nearer end of an interval.
double floats_between(float t, const Interval& exact) {
  const auto word = [](double x) {
    return static_cast<double>(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
  };
  if (t < exact.low) return word(exact.low) - word(t);
  return t > exact.high ? word(t) - word(exact.high) : 0.0;
}

TEST(SetUp, DistancesAreAsNearAsTheySay) {
  Random random;
  const ReferenceBurstUnit unit;
  double worst = 0.0;
  long good = 0;
  for (int i = 0; i < 400000; ++i) {
    const View view = any_view(random, i);
    const SetUpRecord made = set_up(view.origin, view.triangle);
    for (int k = 0; k < 4; ++k) {
      const Ray ray = aimed(random, view);
      if (unit.verdict(made.record, ray.direction) != UnitVerdict::kHit) continue;
      const HitDistance hit = unit.distance(made.record, ray.direction);
      if (!is_good_hit(made, hit.error)) continue;
      const double off = floats_between(hit.t, hit_distance(ray, view.triangle));
      const double most = std::ldexp(1.0, static_cast<int>(t_error_exponent(made, hit.error)));
      ASSERT_LT(off, most) << i;
      worst = std::max(worst, off / most);
      ++good;
    }
  }
  std::cout << good << " hits, worst error " << worst << " of what they say\n";
  EXPECT_GT(good, 100000);
  EXPECT_GT(worst, 0.01);
}

TEST(SetUp, WhatIsNotFiniteIsNeverSure) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {infinity, -infinity, infinity - infinity}) {
    for (int word = 0; word < 12; ++word) {
      glm::vec3 points[4] = {{0, 0, 0}, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};  // origin and corners
      points[word / 3][word % 3] = bad;
      const SetUpRecord made = set_up(points[0], {points[1], points[2], points[3]});
      for (const glm::vec3& way : {glm::vec3(0, 0, 1), glm::vec3(0.2f, -0.1f, 1)}) {
        EXPECT_NE(ReferenceBurstUnit().verdict(made.record, way), UnitVerdict::kHit) << word;
      }
    }
  }
}

TEST(SetUp, NoAreaOrOriginInThePlaneHasNoSign) {
  const glm::vec3 a(1, 2, 3), b(4, 5, 6), c(0, 1, 0);
  EXPECT_TRUE(std::isnan(set_up(glm::vec3(0.3f), {a, a, b}).record.d));
  EXPECT_TRUE(std::isnan(set_up(a, {a, b, c}).record.d));
}

}  // namespace
}  // namespace raygate
