// Tests the words and bounds of records made in double and in binary32: sure verdicts are right.
// Records made four at a time equal those made one by one.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "host/exact/expansion.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/polygon_record.h"
#include "host/intersect/unit/burst_unit.h"

namespace raygate {
namespace {

using test::float_dot;
using test::Random;

/// An origin and a triangle: perhaps a sliver, far away, or with the origin near its plane.
struct View {
  glm::vec3 origin;
  Corners triangle;
};

View any_view(Random& random, int kind) {
  const float far = kind % 2 == 0 ? 0.0f : 1000.0f;
  View view{random.point(), {}};
  FloatCorners t;
  for (glm::vec3& corner : t) corner = random.point() + far;
  if (kind / 2 % 3 == 1) t[2] = glm::mix(t[0], t[1], random.uniform()) + random.point(0x1p-9f);
  if (kind / 6 % 3 == 1) {  // in the plane, except for roundings and a small random offset
    view.origin = t[0] + (t[1] - t[0]) * random.uniform(-2, 2) +
                  (t[2] - t[0]) * random.uniform(-2, 2) +
                  random.point(std::ldexp(1.0f, -random.below(24)));
  }
  view.triangle = widened(t);
  return view;
}

/// Returns a ray from the origin through the triangle, or past an edge as closely as floats allow.
Ray aimed(Random& random, const View& view) {
  const Corners& t = view.triangle;
  const double u = random.uniform(0, 1), v = random.below(2) == 0 ? 0.0 : random.uniform(0, 1);
  const glm::dvec3 inside = glm::mix(glm::mix(t[0], t[1], u), t[2], v);
  const glm::dvec3 aim = inside - glm::dvec3(view.origin);
  const auto off = glm::dvec3(random.point()) * std::ldexp(largest(aim), -random.below(26));
  return {view.origin, scaled_direction(aim + off)};
}

/// Makes records in double (make_record) and in binary32 (set_up).
struct InDouble {
  static PolygonRecord make(const glm::vec3& o, const Corners& t) { return make_record(o, t); }
  static constexpr bool kHasSignOfD = true;  // the sign of d is always exact
};
struct InBinary32 {
  static PolygonRecord make(const glm::vec3& o, const Corners& t) {
    return set_up(o, rounded(t)).record;
  }
  static constexpr bool kHasSignOfD = false;  // d can be NaN
};

template <class Maker>
class Record : public testing::Test {
 protected:
  static PolygonRecord make(const glm::vec3& o, const Corners& t) { return Maker::make(o, t); }
  Random random_;
};

using Makers = testing::Types<InDouble, InBinary32>;
TYPED_TEST_SUITE(Record, Makers);

TYPED_TEST(Record, IsWhatThePaperSays) {
  const PolygonRecord record =
      this->make(glm::vec3(1, 0, 0), {glm::vec3(1, 1, 2), glm::vec3(3, 1, 2), glm::vec3(1, 4, 2)});
  EXPECT_EQ(record.normal, glm::vec3(0, 0, 6));
  EXPECT_EQ(record.d, 12.0f);
  EXPECT_EQ(record.edges[0], glm::cross(glm::vec3(0, 1, 2), glm::vec3(2, 1, 2)));
  EXPECT_EQ(record.edges[1], glm::cross(glm::vec3(2, 1, 2), glm::vec3(0, 4, 2)));
  EXPECT_EQ(record.edges[2], glm::cross(glm::vec3(0, 4, 2), glm::vec3(0, 1, 2)));
}

// Tries to break the bound: compares dot products in float with exact ones, for directions whose
// terms are large and nearly cancel.
TYPED_TEST(Record, BoundHolds) {
  double worst = 0.0;
  for (int i = 0; i < 250'000; ++i) {
    const View view = any_view(this->random_, i);
    const auto& [a, b, c] = view.triangle;
    if (a == b) continue;
    const PolygonRecord record = this->make(view.origin, view.triangle);
    const auto exact = exact_cross(exact_difference(a, view.origin), exact_difference(b, a));
    for (int k = 0; k < 8; ++k) {
      const glm::vec3 direction = aimed(this->random_, view).direction;
      const float u = float_dot(direction, record.edges[0]);
      const auto off = exact_dot(direction, exact) - exact_difference(u, 0.0);
      const auto bound = exact_difference(record.bounds[0], 0.0);
      ASSERT_LT((off - bound).sign(), 0);
      ASSERT_GT((off + bound).sign(), 0);
      worst = std::max(worst, std::abs(off.approximate()) / record.bounds[0]);
    }
  }
  std::cout << "worst error " << worst << " of the bound\n";
  EXPECT_GT(worst, 0.1);  // some cases come near the bound
}

// This includes scales at which unscaled words would leave float's range.
TYPED_TEST(Record, SureAnswersAreRightAtEveryScale) {
  const ReferenceBurstUnit unit;
  long counts[3] = {}, of_known_d = 0;
  for (int i = 0; i < 400'000; ++i) {
    const float size = i % 4 == 0 ? std::ldexp(1.0f, this->random_.below(241) - 125) : 1.0f;
    View view = any_view(this->random_, i);
    view.origin *= size;
    for (glm::dvec3& corner : view.triangle) corner *= double{size};
    const PolygonRecord made = this->make(view.origin, view.triangle);
    if (TypeParam::kHasSignOfD || !std::isnan(made.d)) {
      ASSERT_EQ(orient3d(view.origin, view.triangle), (made.d > 0) - (made.d < 0)) << i;
      ++of_known_d;
    }
    for (int k = 0; k < 4; ++k) {
      const Ray ray = aimed(this->random_, view);
      if (!is_usable(ray.direction)) continue;
      HitDistance distance;
      const UnitVerdict verdict = unit.verdict(made, ray.direction, distance);
      ++counts[static_cast<int>(verdict)];
      if (verdict == UnitVerdict::kDoubt) continue;
      ASSERT_EQ(hits_triangle(ray, view.triangle), verdict == UnitVerdict::kHit) << i;
    }
  }
  for (const long count : counts) EXPECT_GT(count, 100'000);
  EXPECT_GT(of_known_d, 100'000);
}

// No loader accepts infinity or NaN. If given them, no hit is sure and no behaviour is undefined.
TYPED_TEST(Record, WhatIsNotFiniteIsNeverSure) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {infinity, -infinity, infinity - infinity}) {
    for (int word = 0; word < 12; ++word) {
      glm::vec3 points[4] = {{0, 0, 0}, {-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};  // origin and corners
      points[word / 3][word % 3] = bad;
      const PolygonRecord made = this->make(points[0], {points[1], points[2], points[3]});
      for (const glm::vec3& way : {glm::vec3(0, 0, 1), glm::vec3(0.2f, -0.1f, 1)}) {
        HitDistance distance;
        const UnitVerdict verdict = ReferenceBurstUnit().verdict(made, way, distance);
        EXPECT_TRUE(verdict == UnitVerdict::kDoubt ||
                    (!TypeParam::kHasSignOfD && verdict == UnitVerdict::kMiss))
            << word;
      }
    }
  }
}

TYPED_TEST(Record, NoAreaOrOriginInThePlaneHasNoDistance) {
  const glm::vec3 a(1, 2, 3), b(4, 5, 6), c(0, 1, 0);
  for (const float d : {this->make(glm::vec3(0.3f), {a, a, b}).d, this->make(a, {a, b, c}).d}) {
    EXPECT_TRUE(TypeParam::kHasSignOfD ? d == 0.0f : std::isnan(d));
  }
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

/// Returns the number of floats between t and the nearer end of an interval, 0 if t is inside.
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
    const SetUpRecord made = set_up(view.origin, rounded(view.triangle));
    for (int k = 0; k < 4; ++k) {
      const Ray ray = aimed(random, view);
      HitDistance hit;
      if (unit.verdict(made.record, ray.direction, hit) != UnitVerdict::kHit) continue;
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

void expect_same(const glm::vec3& origin, const std::vector<Corners>& triangles) {
  std::vector<PolygonRecord> records(triangles.size());
  make_records(origin, triangles, records);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const PolygonRecord expected = make_record(origin, triangles[i]);
    ASSERT_EQ(std::memcmp(&records[i], &expected, sizeof expected), 0) << "triangle " << i;
    const PolygonRecord plane = make_plane(origin, triangles[i]);
    ASSERT_EQ(std::memcmp(&plane, &expected, 16), 0) << "triangle " << i;
    PlaneViews views;  // four origins, four triangles
    for (std::size_t k = 0; k < kQuad; ++k) {
      views.origins[k] = origin * static_cast<float>(k + 1);
      views.triangles[k] = triangles[(i + k) % triangles.size()];
    }
    float words[4][kQuad];
    make_planes(views, words);
    for (std::size_t k = 0; k < kQuad; ++k) {
      const PolygonRecord single = make_plane(views.origins[k], views.triangles[k]);
      const float found[] = {words[0][k], words[1][k], words[2][k], words[3][k]};
      ASSERT_EQ(std::memcmp(found, &single, sizeof found), 0);
    }
  }
}

TEST(RecordBatch, HasTheBitsOfSingleRecordsAndPlanes) {
  Random random;
  for (int round = 0; round < 2000; ++round) {
    const float size = std::ldexp(1.0f, random.below(5) == 0 ? random.below(240) - 120 : 0);
    const glm::vec3 origin = random.point(size);
    std::vector<Corners> triangles;
    for (int i = random.below(9); i >= 0; --i) {
      FloatCorners t = {random.point(size), random.point(size), random.point(size)};
      const int kind = random.below(8);
      if (kind == 0) t[1] = t[0];                         // an edge without length
      if (kind == 1) t[2] = t[0] + 0.5f * (t[1] - t[0]);  // hardly any area
      if (kind == 2) t[0] = origin;
      for (glm::vec3& v : t) {
        if (kind == 3) v.y = origin.y;  // the origin in the plane
        if (kind == 4) v = origin + 1e-6f * v;
        if (kind == 5) v = 1000.0f * size + 1e-3f * v;
      }
      triangles.push_back(widened(t));
    }
    expect_same(origin, triangles);
  }
  expect_same(glm::vec3(0.1f, 0.2f, 3.0f), test::sphere(4));
}

}  // namespace
}  // namespace raygate
