// NeighborClearances against distances found by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/exact/test/meshes.h"
#include "host/light/spawn_ray.h"

namespace raygate {
namespace {

using test::Random;

/// Of a point and a segment.
double distance(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b) {
  const double t = std::clamp(glm::dot(x - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(x - a - t * (b - a));
}

/// Of a point and a triangle.
double distance(const glm::dvec3& x, const Corners& t) {
  const glm::dvec3 v[3] = {glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])};
  const glm::dvec3 normal = glm::normalize(glm::cross(v[1] - v[0], v[2] - v[0]));
  bool above = true;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3& a = v[k];
    const glm::dvec3& b = v[(k + 1) % 3];
    above = above && glm::dot(glm::cross(normal, b - a), x - a) >= 0.0;
    least = std::min(least, distance(x, a, b));
  }
  return above ? std::abs(glm::dot(normal, x - v[0])) : least;
}

bool is_near(const Overlaps& overlaps, const glm::vec3& point, float reach) {
  return std::ranges::any_of(overlaps, [&](const Overlap& overlap) {
    return overlap.touches(point - reach, point + reach);
  });
}

/// A distance from x in which the overlaps is not; 0 where there is none.
double reach_beyond(const Overlaps& overlaps, const glm::dvec3& x) {
  float reach = 1.0f;
  while (reach > 0.0f && is_near(overlaps, glm::vec3(x), reach)) reach *= 0.5f;
  return reach;
}

/// Whether what is said of a triangle's vertices and plane holds.
void check_shape(const NeighborClearance& clearance, const Corners& t) {
  const glm::dvec3 normal(clearance.normal[0], clearance.normal[1], clearance.normal[2]);
  const glm::dvec3 exact = triangle_normal(t);
  const double scale = largest(normal) / largest(exact);
  EXPECT_EQ(std::exp2(std::round(std::log2(scale))) * exact, normal);
  const double c = std::abs(clearance.length);
  for (int v = 0; v < 3; ++v) {
    EXPECT_EQ(clearance.corner[v], t[0][v]);
    const glm::dvec3 y = glm::dvec3(t[v]) - glm::dvec3(t[0]);
    for (int k = 0; k < 2; ++k) {
      const auto& g = clearance.gradient[k];
      const glm::dvec3 gradient(g[0], g[1], g[2]);
      EXPECT_NEAR(glm::dot(gradient, y), v == k + 1 ? c : 0.0, 0x1p-22 * glm::length(y));
      EXPECT_NEAR(glm::dot(gradient, glm::normalize(exact)), 0.0, 0x1p-24);
      EXPECT_LE(glm::length(gradient), 0.125 + 0x1p-20);
    }
  }
}

struct Seen {
  int points = 0, free = 0;  // those of triangles without a overlaps
};

/// Points of each triangle, most of them near its border.
Seen check(const std::vector<Corners>& mesh, Random& random) {
  const Bvh bvh(test::scene_of(mesh));
  const NeighborClearances clearances(bvh);
  Seen seen;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    const Corners& t = bvh.corners_of(primitive);
    const NeighborClearance& clearance = clearances.of(primitive);
    const double clear = std::abs(clearance.length);
    if (clear > 0.0) check_shape(clearance, t);
    for (int i = 0; i < 2; ++i) {
      ++seen.points;
      seen.free += clearance.length > 0.0f;
      glm::dvec3 w(0.0);
      for (int k = 0; k < 3; ++k) w[k] = std::exp(random.uniform(-12, 0));
      w /= w.x + w.y + w.z;
      const glm::dvec3 x = w.x * glm::dvec3(t[0]) + w.y * glm::dvec3(t[1]) + w.z * glm::dvec3(t[2]);
      double least = std::min(clear * std::min({w.x, w.y, w.z}), spawn_reach(t));
      if (clearance.length < 0.0f) {
        least = std::min(least, reach_beyond(clearances.overlaps_of(primitive), x));
      }
      for (std::uint32_t other = 0; other < bvh.primitive_count(); ++other) {
        const Corners& o = bvh.corners_of(other);
        if (other == primitive || (lies_beyond(o, t, 1) && lies_beyond(o, t, -1))) continue;
        EXPECT_GE(distance(x, o) + 2.0 * clearances.margin(), least) << primitive << " " << other;
      }
    }
  }
  return seen;
}

TEST(NeighborClearance, IsKnownAllOverAClosedMesh) {
  Random random;
  for (const float at : {0.0f, 100.0f}) {
    const Seen seen = check(test::sphere(2, 1.0f, glm::vec3(at)), random);
    EXPECT_EQ(seen.free, seen.points);
  }
  const Seen seen = check(test::box(glm::vec3(-1), glm::vec3(1)), random);
  EXPECT_EQ(seen.free, seen.points);
}

TEST(NeighborClearance, HoldsBetweenTrianglesOfAllKinds) {
  Random random;
  int free = 0, points = 0;
  for (int i = 0; i < 300; ++i) {
    // Some free, some with an edge or a corner in common, some flat.
    const float height = std::exp(random.uniform(-10, 0)), size = std::exp(random.uniform(-3, 0));
    std::vector<Corners> mesh;
    for (int k = 0; k < 8; ++k) {
      Corners t;
      for (glm::dvec3& v : t) v = random.point(size) * glm::vec3(1.0f, 1.0f, height);
      if (k > 0) {
        for (int v = 0; v < random.below(3); ++v) t[v] = mesh[0][(v + k) % 3];
      }
      mesh.push_back(t);
    }
    const Seen seen = check(mesh, random);
    points += seen.points;
    free += seen.free;
  }
  EXPECT_GT(free, points / 20);
  EXPECT_LT(free, points);
}

// All triangles of a fan are near each other; the search for one of them ends early.
TEST(NeighborClearance, IsUnknownInALargeFan) {
  for (const int count : {100, 20'000}) {
    std::vector<Corners> mesh;
    const auto rim = [&](int i) {
      const double angle = 6.283185307179586 * (i % count) / count;
      return glm::dvec3(glm::vec3(std::cos(angle), std::sin(angle), 1.0));
    };
    for (int i = 0; i < count; ++i) mesh.push_back({glm::dvec3(0.0), rim(i), rim(i + 1)});
    const Bvh bvh(test::scene_of(mesh));
    EXPECT_EQ(NeighborClearances(bvh).of(0).length != 0.0f, count == 100) << count;
  }
}

// A table's leg stands on the floor.
TEST(NeighborClearance, WhatStandsOnATriangleIsItsOverlap) {
  const std::vector<Corners> mesh = {
      {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)},
      {glm::vec3(0, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0.1f, 0, 1)}};
  const Bvh bvh(test::scene_of(mesh));
  const NeighborClearances clearances(bvh);
  const std::uint32_t floor = bvh.triangle_of(0) == 0 ? 0 : 1;
  EXPECT_LT(clearances.of(floor).length, 0.0f);
  const Overlaps& overlaps = clearances.overlaps_of(floor);
  EXPECT_EQ(overlaps.size(), 1u);
  EXPECT_TRUE(is_near(overlaps, glm::vec3(-0.01f, 0, 0), 0.01f));
  EXPECT_FALSE(is_near(overlaps, glm::vec3(-0.01f, 0, 0), 0.0099f));
}

// What hovers over a triangle is no overlaps, unless it is very near.
TEST(NeighborClearance, WhatIsBeyondReachDoesNotMatter) {
  for (const bool is_near : {false, true}) {
    const float height = is_near ? 0x1p-19f : 0x1p-17f;
    const Bvh bvh(
        test::scene_of({{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)},
                        {glm::vec3(0, 0, height), glm::vec3(0, 0, 1), glm::vec3(0.1f, 0, 1)}}));
    const NeighborClearances clearances(bvh);
    const float length = clearances.of(bvh.triangle_of(0) == 0 ? 0 : 1).length;
    EXPECT_EQ(length < 0.0f, is_near);
    EXPECT_NEAR(std::abs(length), 0.125f * 4.0f / std::sqrt(5.0f), 1e-4f);
  }
}

}  // namespace
}  // namespace raygate
