// Sure verdicts of test_quad and of QuadRecord agree with exact arithmetic in difficult cases.
#include "host/intersect/cpu/quad_test.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/exact/test/meshes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

enum Parts { kNone = 0, kCorners = 1, kOrigin = 2, kDirection = 4, kAll = 7 };

/// Parameter: which parts are rounded from binary64.
class Quads : public testing::TestWithParam<int> {
 protected:
  /// Returns a binary64 position that rounds to `position` if `part` is rounded, else `position`.
  glm::dvec3 spread(const glm::vec3& position, Parts part) {
    glm::dvec3 exact(position);
    for (int k = 0; k < 3 && (GetParam() & part) != 0; ++k) {
      if (!std::isnormal(position[k])) continue;
      exact[k] = on_float_grid(with_rest(position[k], random_.below(1 << 30) - (1 << 29)));
      if (static_cast<float>(exact[k]) != position[k]) exact[k] = position[k];
    }
    return exact;
  }

  /// Returns the corners in the format of test_quad, followed by arbitrary numbers.
  std::vector<float> words_of(const std::vector<Corners>& triangles) {
    const std::size_t count = triangles.size();
    std::vector<float> words(9 * count + kQuad, random_.uniform());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t v = 0; v < 3; ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
          words[(3 * v + k) * count + i] = static_cast<float>(triangles[i][v][static_cast<int>(k)]);
        }
      }
    }
    return words;
  }

  /// Returns up to four triangles around a point, some with hardly any area or parallel to an axis.
  std::vector<Corners> some_triangles(float size) {
    const float smaller = std::ldexp(1.0f, -random_.below(20));
    const glm::vec3 middle = random_.point(size);
    std::vector<Corners> triangles;
    for (int i = random_.below(kQuad); i >= 0; --i) {
      FloatCorners t;
      for (glm::vec3& v : t) v = middle + random_.point(size * smaller);
      if (random_.below(6) == 0) t[2] = t[0] + 0.4f * (t[1] - t[0]);
      if (random_.below(6) == 0) {
        for (glm::vec3& v : t) v[random_.below(3)] = middle.x;
      }
      triangles.push_back({spread(t[0], kCorners), spread(t[1], kCorners), spread(t[2], kCorners)});
      if (random_.below(12) == 0) triangles.back()[1] = triangles.back()[0];
    }
    return triangles;
  }
  float some_size(int orders) {
    return std::ldexp(1.0f, random_.below(4) == 0 ? random_.below(orders) - orders / 2 : 0);
  }

  static Ray ray_to(const glm::vec3& origin, const glm::dvec3& aim) {
    const glm::dvec3 way = aim - glm::dvec3(origin);
    return {origin, scaled_direction(way == glm::dvec3(0.0) ? glm::dvec3(1.0, 0.0, 0.0) : way)};
  }

  /// Returns a point of the triangle's plane, often near or on an edge.
  glm::dvec3 aim_at(const Corners& t) {
    const auto& [a, b, c] = t;
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
};

/// Compares verdicts of test_quad with the exact predicates.
class QuadTest : public Quads {
 protected:
  void expect_right(const Ray& given, const std::vector<Corners>& triangles) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    const ExactRay ray(spread(given.origin, kOrigin), spread(given.direction, kDirection));
    const ShearedRay sheared(given);
    const double t_scale = std::abs(ray.direction[sheared.axes[2]]);
    QuadVerdict verdict;
    if (GetParam() != kNone) {
      const RoundedParts parts((GetParam() & kCorners) != 0, ray);
      test_quad<true>(sheared, words_of(triangles).data(), count, verdict, parts);
    } else {
      test_quad(sheared, words_of(triangles).data(), count, verdict);
    }
    ASSERT_EQ((verdict.hit | verdict.level | verdict.doubt) >> count, 0u);
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool hit = hits_triangle(ray, triangles[i]);
      if ((verdict.hit >> i & 1) != 0) {
        ++hits_;
        ASSERT_TRUE(hit);
      } else if ((verdict.level >> i & 1) != 0) {
        ++levels_;
        ASSERT_EQ(is_ahead(ray, triangles[i]), hit);
      } else if ((verdict.doubt >> i & 1) != 0) {
        ++doubts_;
      } else {
        ++misses_;
        ASSERT_FALSE(hit);
      }
      if (!hit) continue;
      const Interval t = hit_distance(ray, triangles[i]);
      ASSERT_LE(verdict.low[i], t.high * t_scale);
      ASSERT_GE(verdict.high[i], t.low * t_scale);
    }
  }

  int hits_ = 0, misses_ = 0, levels_ = 0, doubts_ = 0;
};

TEST_P(QuadTest, IsRightWhereItIsSure) {
  for (int round = 0; round < 100'000; ++round) {
    const float size = some_size(80);
    const std::vector<Corners> triangles = some_triangles(size);
    const Corners& aimed = triangles[random_.below(static_cast<int>(triangles.size()))];
    glm::vec3 origin = random_.point(size * std::ldexp(1.0f, 2 - random_.below(10)));
    if (random_.below(4) == 0) origin = glm::vec3(aim_at(aimed));  // on the plane, or nearly
    if (random_.below(8) == 0)
      origin = glm::vec3(aimed[static_cast<std::size_t>(random_.below(3))]);
    expect_right(ray_to(origin, aim_at(aimed)), triangles);
    expect_right(ray_to(origin, glm::dvec3(random_.point(size))), triangles);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(hits_, 10'000);
  EXPECT_GT(misses_, 100'000);
  EXPECT_GT(levels_, 100);
  EXPECT_GT(doubts_, 10'000);
}

// A sphere around the origin: every ray hits one triangle.
TEST_P(QuadTest, IsHardlyEverInDoubt) {
  const std::vector<Corners> mesh = test::sphere(3);
  for (int round = 0; round < 500; ++round) {
    const glm::vec3 origin = random_.point(0.5f);
    const Ray ray = ray_to(origin, glm::dvec3(random_.point(1.0f)));
    for (std::size_t i = 0; i + kQuad <= mesh.size(); i += kQuad) {
      expect_right(ray, {mesh.begin() + static_cast<std::ptrdiff_t>(i),
                         mesh.begin() + static_cast<std::ptrdiff_t>(i + kQuad)});
    }
  }
  EXPECT_GT(hits_, 490);
  EXPECT_LT(doubts_, 5);
}

/// Compares records, and the signs of sides computed from them, with exact values.
class QuadRecordTest : public Quads {
 protected:
  void expect_right(const glm::vec3& origin, const std::vector<Corners>& triangles) {
    const auto count = static_cast<std::uint32_t>(triangles.size());
    QuadRecord record;
    const std::vector<float> words = words_of(triangles);
    GetParam() != kNone ? make_quad_record<true>(origin, words.data(), count, record)
                        : make_quad_record<false>(origin, words.data(), count, record);
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
        expect_right(ray_to(origin, aim_at(triangles[i])), triangles[i], side, record, i);
        if (HasFatalFailure()) return;
      }
    }
  }

  void expect_right(const Ray& ray, const Corners& triangle, int side, const QuadRecord& record,
                    std::uint32_t i) {
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

  int sides_ = 0, unsure_ = 0, sure_ = 0, doubts_ = 0;
  int naive_ = 0;  // doubts in which the computed sign is wrong
};

TEST_P(QuadRecordTest, IsRightWhereItIsSure) {
  for (int round = 0; round < 30'000; ++round) {
    const float size = some_size(70);
    const std::vector<Corners> triangles = some_triangles(size);
    glm::vec3 origin = random_.point(size * std::ldexp(1.0f, 2 - random_.below(10)));
    if (random_.below(8) == 0) {  // in a triangle's plane, or nearly
      origin = glm::vec3(triangles[0][0] + 2.0 * (triangles[0][1] - triangles[0][2]));
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

constexpr float kBeyondFloats[] = {1e-37f, 1e-20f, 1e15f, 1e30f, 8e37f};

TEST_P(QuadTest, IsNotSureOfWhatFloatsCannotHold) {
  for (const float size : kBeyondFloats) {
    for (int round = 0; round < 1000; ++round) {
      const Corners t = {random_.point(size), random_.point(size), random_.point(size)};
      expect_right(ray_to(random_.point(size), aim_at(t)), {t});
    }
  }
  EXPECT_EQ(hits_ + misses_, 0);
}

TEST_P(QuadRecordTest, IsNotSureOfWhatFloatsCannotHold) {
  for (const float size : kBeyondFloats) {
    for (int round = 0; round < 300; ++round) {
      expect_right(random_.point(size),
                   {{random_.point(size), random_.point(size), random_.point(size)}});
    }
  }
  EXPECT_EQ(sides_ + sure_, 0);
  EXPECT_GT(doubts_, 0);
}

INSTANTIATE_TEST_SUITE_P(Rounded, QuadTest,
                         testing::Values(kNone, kCorners, kOrigin, kDirection, kAll));
INSTANTIATE_TEST_SUITE_P(Rounded, QuadRecordTest, testing::Values(kNone, kCorners));

}  // namespace
}  // namespace raygate
