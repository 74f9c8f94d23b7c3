// Compares the exact predicates with rational arithmetic, and tests their hits of closed meshes.
#include "host/exact/exact.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "host/exact/test/meshes.h"
#include "host/exact/test/rational_oracle.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::cross;
using test::dot;
using test::minus;
using test::Random;
using test::rational;
using test::Rational3;
using Oracle = test::RationalOracle;

struct Case {
  ExactRay ray;
  Corners triangle;
};

/// Returns a ray and a triangle of any size, mostly difficult: aimed at a vertex or an edge, a
/// sliver, far away, or with few bits, so that ties are common. Half of the cases are in binary64.
Case hard_case(Random& random) {
  const bool is_binary64 = random.below(2) == 0;
  const float size = std::ldexp(1.0f, random.below(201) - 100);
  const float far = random.below(3) == 0 ? size * std::ldexp(1.0f, random.below(24)) : 0.0f;
  const bool grid = random.below(3) == 0;
  const auto point = [&] {
    glm::vec3 p = random.point(size);
    if (grid) p = glm::round(p / size * 3.0f) * size;
    p += glm::vec3(far, -far, far);
    glm::dvec3 exact(p);
    for (int k = 0; k < 3 && is_binary64 && !grid; ++k) {
      if (p[k] != 0.0f)
        exact[k] = on_float_grid(with_rest(p[k], random.below(1 << 29) - (1 << 28)));
    }
    return exact;
  };
  Corners t = {point(), point(), point()};
  if (random.below(5) == 0) t[2] = glm::mix(t[0], t[1], random.uniform(0, 1));  // a sliver
  if (!is_binary64) t[2] = glm::vec3(t[2]);
  const glm::dvec3 origin = point();
  glm::dvec3 aim;
  switch (random.below(4)) {
    case 0:
      aim = t[static_cast<std::size_t>(random.below(3))];
      break;
    case 1:
      aim = glm::mix(t[0], t[1], random.uniform(0, 1));
      break;
    case 2:
      aim = (t[0] + t[1] + t[2]) / 3.0;
      break;
    default:
      aim = point();
      break;
  }
  glm::dvec3 direction = aim - origin;
  if (direction == glm::dvec3(0.0)) direction.x = 1.0;
  const glm::dvec3 rounded(scaled_direction(direction));
  if (!is_binary64) return {{origin, rounded}, t};
  direction *= std::exp2(std::round(std::log2(largest(rounded) / largest(direction))));
  for (int k = 0; k < 3; ++k) direction[k] = on_float_grid(direction[k]);
  return {{origin, direction}, t};
}

/// Expects that the error of `rounded` is at most (1 + 2^-10) / 2 ulp of float.
void expect_near_half_an_ulp(float rounded, const mpq_class& exact) {
  if (!std::isfinite(rounded)) {
    EXPECT_GT(abs(exact), 0x1.fffffep127);
    return;
  }
  const int exponent = rounded == 0.0f ? -126 : std::max(std::ilogb(rounded), -126);
  EXPECT_LE(abs(rounded - exact), std::ldexp(0.5 + 0x1p-11, exponent - 23)) << rounded;
}

TEST(Exact, AgreesWithRationals) {
  Random random;
  int hits = 0, ties = 0;
  for (int i = 0; i < 30000; ++i) {
    const auto [ray, t] = hard_case(random);
    const Oracle oracle(ray, t);
    ASSERT_EQ(orient3d(ray.origin, t), sgn(oracle.plane())) << "case " << i;
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(edge_side(ray, t[k], t[(k + 1) % 3]), oracle.side(k)) << "case " << i;
      ties += dot(oracle.direction, cross(oracle.v[k], oracle.v[(k + 1) % 3])) == 0 ? 1 : 0;
    }
    ASSERT_EQ(hits_triangle(ray, t), oracle.hit()) << "case " << i;
    if (!oracle.hit()) continue;
    ++hits;
    const Interval interval = hit_distance(ray, t);
    const mpq_class exact = oracle.t();
    ASSERT_GT(exact, 0);
    ASSERT_LE(mpq_class(interval.low), exact);
    ASSERT_GE(mpq_class(interval.high), exact);
    ASSERT_LE(interval.high, interval.low * (1.0 + 0x1p-34));
    const PreciseHit precise = precise_hit(ray, t);
    expect_near_half_an_ulp(precise.t, exact);
    for (int k = 0; k < 3; ++k) {
      expect_near_half_an_ulp(precise.point[k], exact * oracle.direction[k]);
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(ties, 1000);
}

TEST(Exact, RoundedWordsKeepTheirPromise) {
  Random random;
  for (int i = 0; i < 20000; ++i) {
    const auto [ray, t] = hard_case(random);
    const Oracle oracle(ray, t);
    const mpq_class d = oracle.plane(), off = plane_distance(ray.origin, t) - d;
    ASSERT_LE(abs(off) * 0x1p32, abs(d)) << "case " << i;
    const Rational3 exact = cross(oracle.v[0], oracle.v[1]);
    const glm::dvec3 edge = edge_normal(ray.origin, t[0], t[1]);
    const double size = std::abs(edge.x) + std::abs(edge.y) + std::abs(edge.z);
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(abs(edge[k] - exact[k]), mpq_class(size) / 0x1p34) << "case " << i;
    }
  }
}

void expect_barycentric(const ExactRay& ray, const Corners& t) {
  const Oracle oracle(ray, t);
  mpq_class weights[3], sum = 0;
  for (int k = 0; k < 3; ++k) {
    weights[k] = dot(oracle.direction, cross(oracle.v[(k + 1) % 3], oracle.v[(k + 2) % 3]));
    sum += weights[k];
  }
  const Barycentric place = barycentric(ray, t);
  ASSERT_TRUE(place.u >= 0.0 && place.v >= 0.0 && 1.0 - place.u - place.v >= 0.0);
  const mpq_class bound(0x1p-34);
  ASSERT_LE(abs(mpq_class(place.u) - weights[1] / sum), bound) << place.u;
  ASSERT_LE(abs(mpq_class(place.v) - weights[2] / sum), bound) << place.v;
}

TEST(Exact, BarycentricsKeepTheirPromise) {
  Random random;
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto [ray, t] = hard_case(random);
    if (!hits_triangle(ray, t)) continue;
    ++hits;
    expect_barycentric(ray, t);
  }
  EXPECT_GT(hits, 1000);
  // Triangles so small and far away that weights computed in double are only rounding errors.
  for (const float s : {1e-10f, 1e-16f, 1e-30f}) {
    const Corners t = {glm::vec3(-s, -s, 0), glm::vec3(2 * s, -s, -s / 2),
                       glm::vec3(-s, 3 * s, s / 4)};
    const Ray ray = {glm::vec3(0.75f, 1, 0.5f), glm::vec3(-0.75f, -1, -0.5f)};
    ASSERT_TRUE(hits_triangle(ray, t));
    expect_barycentric(ray, t);
  }
}

// The second triangle has the vertices of the first in another order. In a third of the cases, one
// coordinate is an ulp larger; in another third, one vertex is replaced by another point.
TEST(Exact, OrdersHitsAsRationalsDo) {
  Random random;
  int compared = 0, equal = 0;
  for (int i = 0; i < 60000; ++i) {
    const auto [ray, t] = hard_case(random);
    if (!hits_triangle(ray, t)) continue;
    Corners other = {t[1], t[2], t[0]};
    const int kind = random.below(3);
    const int k = random.below(3);
    if (kind == 1) other[k].x = std::nextafter(float_above(other[k].x), 1e38f);
    if (kind == 2) other[k] = hard_case(random).triangle[0];
    if (!hits_triangle(ray, other)) continue;
    const int expected = cmp(Oracle(ray, t).t(), Oracle(ray, other).t());
    ASSERT_EQ(compare_hits(ray, t, other), expected < 0 ? -1 : (expected > 0 ? 1 : 0));
    ASSERT_EQ(compare_hits(ray, other, t), expected < 0 ? 1 : (expected > 0 ? -1 : 0));
    ++compared;
    equal += expected == 0 ? 1 : 0;
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(equal, 100);
}

// Uses rationals to compare the position of a hit with another triangle's plane and with a limit.
TEST(Exact, SidesAndLimitsAtAHitAgreeWithRationals) {
  Random random;
  int hits = 0, on_plane = 0;
  for (int i = 0; i < 60000; ++i) {
    const auto [ray, t] = hard_case(random);
    Corners other = hard_case(random).triangle;
    for (int k = 0; k < random.below(4); ++k) other[k] = t[(k + 1) % 3];
    ASSERT_EQ(
        direction_side(ray.direction, other),
        sgn(dot(rational(ray.direction), cross(minus(rational(other[1]), rational(other[0])),
                                               minus(rational(other[2]), rational(other[0]))))));
    if (!hits_triangle(ray, t)) continue;
    ++hits;
    const Oracle oracle(ray, t);
    const mpq_class distance = oracle.t();
    Rational3 v[3];  // the other triangle, seen from the hit
    for (int k = 0; k < 3; ++k) {
      v[k] = minus(rational(other[k]), rational(ray.origin));
      for (int axis = 0; axis < 3; ++axis) v[k][axis] -= distance * oracle.direction[axis];
    }
    const int side = sgn(dot(v[0], cross(v[1], v[2])));
    ASSERT_EQ(plane_side_at_hit(ray, t, other), side);
    on_plane += side == 0 ? 1 : 0;
    const double near = distance.get_d(), rounded = static_cast<float>(near);
    for (const double limit :
         {near, std::nextafter(near, 0.0), std::nextafter(near, 1e300), rounded}) {
      if (!(limit >= 0x1p-149 && limit < 0x1p128)) continue;
      const int order = cmp(distance, mpq_class(limit));
      ASSERT_EQ(compare_hit_to_limit(ray, t, limit), order < 0 ? -1 : (order > 0 ? 1 : 0));
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(on_plane, 100);
}

/// Expects that every ray from a point inside a closed convex mesh hits exactly one triangle.
void expect_one_hit_each(const std::vector<Corners>& mesh, const glm::vec3& inside, Random& random,
                         int rays) {
  int aimed_exactly = 0;
  for (int i = 0; i < rays; ++i) {
    const Corners& target = mesh[random.below(static_cast<int>(mesh.size()))];
    const double along =
        random.below(2) == 0 ? 0.0 : (random.below(2) == 0 ? 0.5 : random.uniform(0, 1));
    const glm::dvec3 aim = glm::mix(glm::dvec3(target[0]), glm::dvec3(target[1]), along);
    const Ray ray = {inside, scaled_direction(aim - glm::dvec3(inside))};
    int hits = 0;
    for (const Corners& t : mesh) hits += hits_triangle(ray, t) ? 1 : 0;
    ASSERT_EQ(hits, 1) << "ray " << i;
    Corners pair = target;
    pair[2] = target[0];
    const Oracle oracle(ray, pair);
    aimed_exactly += dot(oracle.direction, cross(oracle.v[0], oracle.v[1])) == 0 ? 1 : 0;
  }
  EXPECT_GT(aimed_exactly, 0);
}

TEST(Exact, NoLeakNoDoubleHitInAClosedMesh) {
  Random random;
  expect_one_hit_each(test::sphere(2), glm::vec3(0.0f), random, 3000);
  expect_one_hit_each(test::sphere(2), glm::vec3(0.25f, -0.125f, 0.5f), random, 3000);
  expect_one_hit_each(test::sphere(2, 1.0f, glm::vec3(1e4f)), glm::vec3(1e4f), random, 1000);
  expect_one_hit_each(test::sphere(2, 1e-3f), glm::vec3(0.0f), random, 1000);
  expect_one_hit_each(test::box(glm::vec3(-1), glm::vec3(1)), glm::vec3(0.0f), random, 5000);
  expect_one_hit_each(test::box(glm::vec3(-1), glm::vec3(1)), glm::vec3(0.5f, 0, 0), random, 5000);
  expect_one_hit_each(test::box(glm::vec3(1e30f), glm::vec3(3e30f)), glm::vec3(2e30f), random,
                      1000);
}

TEST(Exact, OriginInThePlaneOrBehindIsNoHit) {
  const Corners t = {glm::vec3(-1, -1, 1), glm::vec3(1, -1, 1), glm::vec3(0, 1, 1)};
  EXPECT_TRUE(hits_triangle({glm::vec3(0, 0, 0), glm::vec3(0, 0, 1)}, t));
  EXPECT_FALSE(hits_triangle({glm::vec3(0, 0, 0), glm::vec3(0, 0, -1)}, t));
  EXPECT_FALSE(hits_triangle({glm::vec3(0, 0, 2), glm::vec3(0, 0, 1)}, t));
  EXPECT_FALSE(hits_triangle({glm::vec3(0, 0, 1), glm::vec3(0, 0, 1)}, t));
  EXPECT_FALSE(hits_triangle({glm::vec3(-5, 0, 1), glm::vec3(1, 0, 0)}, t));
  EXPECT_FALSE(hits_triangle({glm::vec3(0), glm::vec3(0, 0, 1)}, {t[0], t[0], t[1]}));
}

TEST(ExactOrigin, KeepsFarPositionsInRange) {
  std::vector<glm::dvec3> positions(2, glm::dvec3(-0x1.fp125, 0, 0));
  for (int i = 0; i < 6; ++i) positions.emplace_back(0x1.fp125 + i * 0x1p80, 0, 0);
  const glm::dvec3 origin = exact_origin(positions);
  for (const glm::dvec3& at : positions) {
    EXPECT_LE(largest(at - origin), kMostCoordinate);
    EXPECT_TRUE(has_exact_difference(at.x, origin.x));
  }
}

}  // namespace
}  // namespace raygate
