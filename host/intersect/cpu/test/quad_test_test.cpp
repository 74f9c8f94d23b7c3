// What float32 calls sure is so in exact arithmetic, however hard rays and triangles make it.
#include "host/intersect/cpu/quad_test.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/exact/test/meshes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

/// Verdicts on rays and triangles against the exact ones.
class QuadTest : public testing::Test {
 protected:
  struct Counts {
    int hits = 0, misses = 0, levels = 0, doubts = 0;
  };

  void expect_right(const Ray& ray, const std::vector<Corners>& triangles) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    std::vector<float> words(9 * triangles.size() + kQuad, random_.uniform());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (int v = 0; v < 3; ++v) {
        for (int k = 0; k < 3; ++k) words[(3 * v + k) * count + i] = triangles[i][v][k];
      }
    }
    const ShearedRay sheared(ray);
    const double t_scale = std::abs(ray.direction[sheared.axes[2]]);
    QuadVerdict verdict;
    test_quad(sheared, words.data(), count, verdict);
    ASSERT_EQ((verdict.hit | verdict.level | verdict.doubt) >> count, 0u);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool hit = hits_triangle(ray, triangles[i]);
      if ((verdict.hit >> i & 1) != 0) {
        ++counts_.hits;
        ASSERT_TRUE(hit);
      } else if ((verdict.level >> i & 1) != 0) {
        ++counts_.levels;
        ASSERT_EQ(is_ahead(ray, triangles[i]), hit);
      } else if ((verdict.doubt >> i & 1) != 0) {
        ++counts_.doubts;
      } else {
        ++counts_.misses;
        ASSERT_FALSE(hit);
      }
      if (!hit) continue;
      const Interval t = hit_distance(ray, triangles[i]);
      ASSERT_LE(verdict.low[i], t.high * t_scale);
      ASSERT_GE(verdict.high[i], t.low * t_scale);
    }
  }

  Ray ray_to(const glm::vec3& origin, const glm::dvec3& aim) {
    const glm::dvec3 way = aim - glm::dvec3(origin);
    return {origin, scaled_direction(way == glm::dvec3(0.0) ? glm::dvec3(1.0, 0.0, 0.0) : way)};
  }

  /// A point of the triangle's plane, near or on an edge as often as not.
  glm::dvec3 aim_at(const Corners& t) {
    const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
    const auto near_zero = [&] {
      return random_.below(3) == 0 ? 0.0 : std::ldexp(random_.uniform(), -random_.below(40));
    };
    switch (random_.below(4)) {
      case 0:
        return a + 0.5 * (random_.uniform() + 1.0) * (b - a) + near_zero() * (c - a);
      case 1:
        return c + near_zero() * (a - c) + near_zero() * (b - c);
      case 2:
        return (a + b + c) / 3.0;
      default:
        return a + double(random_.uniform()) * (b - a) + double(random_.uniform()) * (c - a);
    }
  }

  Random random_;
  Counts counts_;
};

TEST_F(QuadTest, IsRightWhereItIsSure) {
  for (int round = 0; round < 100'000; ++round) {
    const float size = std::ldexp(1.0f, random_.below(4) == 0 ? random_.below(80) - 40 : 0);
    const float smaller = std::ldexp(1.0f, -random_.below(20));
    const glm::vec3 middle = random_.point(size);
    std::vector<Corners> triangles;
    for (int i = random_.below(kQuad); i >= 0; --i) {
      Corners t;
      for (glm::vec3& v : t) v = middle + random_.point(size * smaller);
      if (random_.below(6) == 0) t[2] = t[0] + 0.4f * (t[1] - t[0]);  // hardly any area
      if (random_.below(12) == 0) t[1] = t[0];
      if (random_.below(6) == 0) {
        for (glm::vec3& v : t) v[random_.below(3)] = middle.x;
      }
      triangles.push_back(t);
    }
    const Corners& aimed = triangles[random_.below(static_cast<int>(triangles.size()))];
    glm::vec3 origin = random_.point(size * std::ldexp(1.0f, 2 - random_.below(10)));
    if (random_.below(4) == 0) origin = glm::vec3(aim_at(aimed));  // on it, or nearly
    if (random_.below(8) == 0) origin = aimed[random_.below(3)];
    expect_right(ray_to(origin, aim_at(aimed)), triangles);
    expect_right(ray_to(origin, glm::dvec3(random_.point(size))), triangles);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(counts_.hits, 10'000);
  EXPECT_GT(counts_.misses, 100'000);
  EXPECT_GT(counts_.levels, 100);
  EXPECT_GT(counts_.doubts, 10'000);
}

// A sphere around the origin: every ray hits one triangle.
TEST_F(QuadTest, IsHardlyEverInDoubt) {
  const std::vector<Corners> mesh = test::sphere(3);
  for (int round = 0; round < 500; ++round) {
    const glm::vec3 origin = random_.point(0.5f);
    const Ray ray = ray_to(origin, glm::dvec3(random_.point(1.0f)));
    for (std::size_t i = 0; i + kQuad <= mesh.size(); i += kQuad) {
      expect_right(ray, {mesh.begin() + static_cast<std::ptrdiff_t>(i),
                         mesh.begin() + static_cast<std::ptrdiff_t>(i + kQuad)});
    }
  }
  EXPECT_GT(counts_.hits, 490);
  EXPECT_LT(counts_.doubts, 5);
}

TEST_F(QuadTest, IsNotSureOfWhatFloatsCannotHold) {
  for (const float size : {1e-37f, 1e-20f, 1e15f, 1e30f, 8e37f}) {
    for (int round = 0; round < 1000; ++round) {
      const std::vector<Corners> triangles = {
          {random_.point(size), random_.point(size), random_.point(size)}};
      expect_right(ray_to(random_.point(size), aim_at(triangles[0])), triangles);
    }
  }
  EXPECT_EQ(counts_.hits + counts_.misses, 0);
}

}  // namespace
}  // namespace raygate
