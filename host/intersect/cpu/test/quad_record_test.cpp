// What records in float32 call sure is so in exact arithmetic.
#include <gtest/gtest.h>

#include <vector>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/quad_test.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

class QuadRecordTest : public testing::Test {
 protected:
  /// Directions from the origin, near or on the triangles' edges as often as not.
  glm::vec3 direction_to(const glm::vec3& origin, const Corners& t) {
    const auto near_zero = [&] {
      return random_.below(3) == 0 ? 0.0 : std::ldexp(random_.uniform(), -random_.below(40));
    };
    const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
    glm::dvec3 aim;
    switch (random_.below(3)) {
      case 0:
        aim = a + 0.5 * (random_.uniform() + 1.0) * (b - a) + near_zero() * (c - a);
        break;
      case 1:
        aim = c + near_zero() * (a - c) + near_zero() * (b - c);
        break;
      default:
        aim = (a + b + c) / 3.0 + glm::dvec3(random_.point(glm::length(t[1] - t[0])));
    }
    const glm::dvec3 way = aim - glm::dvec3(origin);
    return scaled_direction(way == glm::dvec3(0.0) ? glm::dvec3(1.0, 0.0, 0.0) : way);
  }

  void expect_right(const glm::vec3& origin, const std::vector<Corners>& triangles) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    std::vector<float> words(9 * triangles.size() + kQuad, random_.uniform());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (int v = 0; v < 3; ++v) {
        for (int k = 0; k < 3; ++k) words[(3 * v + k) * count + i] = triangles[i][v][k];
      }
    }
    QuadRecord record;
    make_quad_record({origin.x, origin.y, origin.z}, words.data(), count, record);
    ASSERT_EQ(record.unsure >> count, 0u);
    for (std::uint32_t i = 0; i < count; ++i) {
      const int side = orient3d(origin, triangles[i]);
      if ((record.unsure >> i & 1) == 0) {
        ASSERT_EQ(side, record.flip[i] != 0 ? -1 : 1);
        ++sides_;
      } else {
        ++unsure_;
        if (side == 0) continue;
        set_side(record, static_cast<int>(i), side);
      }
      const double d = std::abs(plane_distance(origin, triangles[i]));
      ASSERT_LE(record.low[i], d * (1.0 + 0x1p-30));
      ASSERT_GE(record.high[i], d * (1.0 - 0x1p-30));
      for (int round = 0; round < 10; ++round) {
        expect_right(origin, triangles[i], side, record, i);
        if (HasFatalFailure()) return;
      }
    }
  }

  void expect_right(const glm::vec3& origin, const Corners& triangle, int side,
                    const QuadRecord& record, std::uint32_t i) {
    const Ray ray = {origin, direction_to(origin, triangle)};
    const glm::vec3& d = ray.direction;
    const auto dot = [&](int plane) {
      const auto word = [&](int axis) { return record.word(plane, axis, static_cast<int>(i)); };
      return (d.x * word(0) + d.y * word(1)) + d.z * word(2);
    };
    for (int e = 0; e < 3; ++e) {
      const float u = dot(e);
      const int exact = side * edge_side(ray, triangle[e], triangle[(e + 1) % 3]);
      if (std::abs(u) > record.bounds[i]) {
        ++sure_;
        ASSERT_EQ(u > 0.0f ? 1 : -1, exact);
      } else {
        ++doubts_;
        naive_ += (u > 0.0f ? 1 : -1) != exact;
      }
    }
    const float v = dot(QuadRecord::kNormal);
    if (std::isfinite(record.bounds[i]) && std::abs(v) > record.normal_bound[i]) {
      ASSERT_EQ(v > 0.0f ? 1 : -1, side * direction_side(d, triangle));
    }
    if (!hits_triangle(ray, triangle) || std::isinf(record.bounds[i])) return;
    const Interval t = hit_distance(ray, triangle);
    const double most = static_cast<double>(v) + record.normal_bound[i];
    const double least = static_cast<double>(v) - record.normal_bound[i];
    ASSERT_LE(record.low[i], t.high * most * (1.0 + 0x1p-22));
    if (least > 0.0) {
      ASSERT_GE(record.high[i], t.low * least * (1.0 - 0x1p-22));
    }
  }

  Random random_;
  int sides_ = 0, unsure_ = 0, sure_ = 0, doubts_ = 0;
  int naive_ = 0;  // doubts about which the sign would be wrong
};

TEST_F(QuadRecordTest, IsRightWhereItIsSure) {
  for (int round = 0; round < 30'000; ++round) {
    const float size = std::ldexp(1.0f, random_.below(4) == 0 ? random_.below(70) - 35 : 0);
    const float smaller = std::ldexp(1.0f, -random_.below(20));
    const glm::vec3 middle = random_.point(size);
    std::vector<Corners> triangles;
    for (int i = random_.below(kQuad); i >= 0; --i) {
      Corners t;
      for (glm::vec3& v : t) v = middle + random_.point(size * smaller);
      if (random_.below(6) == 0) t[2] = t[0] + 0.4f * (t[1] - t[0]);  // hardly any area
      if (random_.below(12) == 0) t[1] = t[0];
      triangles.push_back(t);
    }
    glm::vec3 origin = random_.point(size * std::ldexp(1.0f, 2 - random_.below(10)));
    if (random_.below(8) == 0) {  // in a plane, or nearly
      origin = triangles[0][0] + 2.0f * (triangles[0][1] - triangles[0][2]);
    }
    expect_right(origin, triangles);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(sides_, 30'000);
  EXPECT_GT(unsure_, 1'000);
  EXPECT_GT(sure_, 500'000);
  EXPECT_GT(doubts_, 100'000);
  EXPECT_GT(naive_, 10'000);
}

TEST_F(QuadRecordTest, IsNotSureOfWhatFloatsCannotHold) {
  for (const float size : {1e-37f, 1e-20f, 1e15f, 1e30f, 8e37f}) {
    for (int round = 0; round < 300; ++round) {
      expect_right(random_.point(size),
                   {{random_.point(size), random_.point(size), random_.point(size)}});
    }
  }
  EXPECT_EQ(sides_ + sure_, 0);
  EXPECT_GT(doubts_, 0);
}

}  // namespace
}  // namespace raygate
