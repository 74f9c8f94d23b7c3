// Rays reflected inside closed meshes stay inside, even in the sharpest corners. Clearances agree
// with distances found by brute force.
#include "host/light/spawn_ray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "host/base/test/using_vectors.h"
#include "host/exact/exact.h"
#include "host/exact/test/meshes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

/// A prism along z whose section is a triangle with an angle of about `angle` rad at the z axis.
std::vector<Corners> wedge(float angle, const glm::vec3& at) {
  const auto point = [&](float x, float y, float z) { return at + glm::vec3(x, y, z); };
  const glm::vec3 a[2] = {point(0, 0, -1), point(0, 0, 1)};
  const glm::vec3 b[2] = {point(1, 0, -1), point(1, 0, 1)};
  const glm::vec3 c[2] = {point(1, angle, -1), point(1, angle, 1)};
  return {{a[0], b[0], b[1]}, {a[0], b[1], a[1]}, {a[0], c[1], c[0]}, {a[0], a[1], c[1]},
          {b[0], c[0], c[1]}, {b[0], c[1], b[1]}, {a[0], c[0], b[0]}, {a[1], b[1], c[1]}};
}

std::optional<std::uint32_t> nearest(const Bvh& bvh, const Ray& ray) {
  std::optional<std::uint32_t> best;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    const Corners& t = bvh.corners_of(primitive);
    if (!hits_triangle(ray, t)) continue;
    if (!best || compare_hits(ray, t, bvh.corners_of(*best)) < 0) best = primitive;
  }
  return best;
}

/// Returns whether a point is inside, by the parity of the hits of a ray.
bool inside(const Bvh& bvh, const glm::vec3& point) {
  int hits = 0;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    hits += hits_triangle({point, glm::vec3(0.371f, 1.02f, -0.593f)}, bvh.corners_of(primitive));
  }
  return hits % 2 == 1;
}

glm::vec3 mirrored(const glm::vec3& direction, const Corners& t) {
  const glm::dvec3 n = glm::normalize(triangle_normal(t)), d(direction);
  return scaled_direction(d - 2.0 * glm::dot(d, n) * n);
}

struct Bounces {
  int rays = 0, bounces = 0, ended = 0;
  double farthest = 0.0;  // largest |O' - X| on an axis, in float steps of X
};

double steps_between(const glm::vec3& point, const Ray& ray, const Corners& t) {
  const Interval range = hit_distance(ray, t);
  const glm::dvec3 x =
      glm::dvec3(ray.origin) + 0.5 * (range.low + range.high) * glm::dvec3(ray.direction);
  const glm::dvec3 off = glm::abs(glm::dvec3(point) - x), size = glm::abs(x);
  const auto largest = static_cast<float>(std::max({size.x, size.y, size.z}));
  return std::max({off.x, off.y, off.z}) / (std::nextafter(largest, 3e38f) - largest);
}

/// Traces rays from `start` towards edges and vertices, mirrored at each hit. Every ray must hit
/// something, and every origin must be inside.
Bounces bounce(const std::vector<Corners>& mesh, const glm::vec3& start, Random& random, int rays) {
  const Bvh bvh(test::scene_of(mesh));
  const NeighborClearances clearances(bvh);
  RaySpawner spawner(clearances);
  EXPECT_TRUE(inside(bvh, start));
  Bounces result;
  for (; result.rays < rays; ++result.rays) {
    const Corners& target = mesh[random.below(static_cast<int>(mesh.size()))];
    const float along = random.below(2) == 0 ? 0.0f : random.uniform(0, 1);
    const float off = std::exp(random.uniform(-20, -1));
    const glm::dvec3 aim = glm::mix(glm::dvec3(target[0]), glm::dvec3(target[1]), along) +
                           glm::dvec3(random.point(off)) - glm::dvec3(start);
    Ray ray = {start, scaled_direction(aim)};
    for (int i = 0; i < 20; ++i) {
      const auto primitive = nearest(bvh, ray);
      if (!primitive) {
        ADD_FAILURE() << "a ray escaped";
        return result;
      }
      const Corners& t = bvh.corners_of(*primitive);
      const auto origin = spawner.find(ray, *primitive, SpawnSide::kIncident);
      if (!origin) {
        ++result.ended;
        break;
      }
      result.farthest = std::max(result.farthest, steps_between(*origin, ray, t));
      EXPECT_TRUE(inside(bvh, *origin));
      const glm::vec3 direction = mirrored(ray.direction, t);
      if (!spawner.leaves(ray, *primitive, SpawnSide::kIncident, direction)) break;
      ray = {*origin, direction};
      EXPECT_FALSE(hits_triangle(ray, t));
      ++result.bounces;
    }
  }
  return result;
}

TEST(RaySpawner, NoBounceLeavesAClosedMesh) {
  Random random;
  const auto expect = [&](const std::vector<Corners>& mesh, const glm::vec3& start) {
    const Bounces result = bounce(mesh, start, random, 100);
    EXPECT_GT(result.bounces, 500);
    EXPECT_EQ(result.ended, 0);
    std::cout << result.bounces << " bounces, farthest " << result.farthest << " floats\n";
  };
  expect(test::box(glm::vec3(-1), glm::vec3(1)), glm::vec3(0.25f, 0, 0.5f));
  expect(test::box(glm::vec3(1e6f), glm::vec3(1e6f + 1)), glm::vec3(1e6f + 0.5f));
  expect(test::box(glm::vec3(1e-18f), glm::vec3(3e-18f)), glm::vec3(2e-18f));
  expect(test::box(glm::vec3(-3e30f), glm::vec3(1e30f)), glm::vec3(1e29f));
  expect(test::sphere(1), glm::vec3(0.1f, 0.2f, 0.3f));
}

// Rays run into edges with angles from 1 to 1e-6 rad. Origins move back, or the ray ends.
TEST(RaySpawner, NoBounceLeavesASharpCorner) {
  Random random;
  for (const float angle : {1.0f, 0.1f, 1e-2f, 1e-4f, 1e-6f}) {
    for (const float at : {0.0f, 3.0f}) {
      if (at * 1e-7f > angle) continue;
      const auto mesh = wedge(angle, glm::vec3(at));
      const glm::vec3 start = glm::vec3(at) + glm::vec3(0.7f, 0.3f * angle, 0.1f);
      if (!inside(Bvh(test::scene_of(mesh)), start)) continue;
      const Bounces result = bounce(mesh, start, random, 50);
      EXPECT_GT(result.bounces, 500);
      EXPECT_EQ(result.ended, 0);  // the wedge is convex
      std::cout << "angle " << angle << " at " << at << ": " << result.bounces << " bounces, "
                << result.ended << " rays ended, farthest " << result.farthest << " floats\n";
    }
  }
}

// Rays from outside meet edges of a sphere that are so flat that the planes of both triangles are
// less than a float step apart. No ray ends, and both origins are on their sides of the surface.
TEST(RaySpawner, NoRayEndsOnARidge) {
  Random random;
  const std::vector<Corners> mesh = test::sphere(4);
  const Bvh bvh(test::scene_of(mesh));
  const NeighborClearances clearances(bvh);
  RaySpawner spawner(clearances);
  int hits = 0;
  for (int i = 0; i < 600; ++i) {
    const glm::vec3 eye = 3.0f * glm::normalize(random.point() + 1e-3f);
    const Corners& target = mesh[random.below(static_cast<int>(mesh.size()))];
    const glm::dvec3 aim =
        glm::mix(glm::dvec3(target[0]), glm::dvec3(target[1]), random.uniform(0, 1)) +
        glm::dvec3(random.point(std::exp(random.uniform(-18, -13)))) - glm::dvec3(eye);
    const Ray ray = {eye, scaled_direction(aim)};
    const auto primitive = nearest(bvh, ray);
    if (!primitive) continue;
    ++hits;
    const auto before = spawner.find(ray, *primitive, SpawnSide::kIncident);
    const auto after = spawner.find(ray, *primitive, SpawnSide::kTransmitted);
    ASSERT_TRUE(before && after) << i;
    ASSERT_FALSE(inside(bvh, *before)) << i;
    ASSERT_TRUE(inside(bvh, *after)) << i;
  }
  EXPECT_GT(hits, 500);
}

// Between two spheres, one of which touches a floor, single and batched queries agree.
TEST(RaySpawner, ManyAtOnceAreTheSame) {
  Random random;
  std::vector<Corners> mesh = test::sphere(3);
  for (const Corners& t : test::sphere(2, 0.5f, glm::vec3(1.2f, 0.0f, 0.0f))) mesh.push_back(t);
  for (const Corners& t : test::box(glm::vec3(-3, -2, -3), glm::vec3(3, -1, 3))) mesh.push_back(t);
  const Bvh bvh(test::scene_of(mesh));
  const NeighborClearances clearances(bvh);
  RaySpawner spawner(clearances);
  std::vector<Ray> rays;
  std::vector<SpawnQuery> questions;
  for (int i = 0; i < 2003; ++i) {
    const glm::vec3 eye = 4.0f * glm::normalize(random.point() + 1e-3f);
    rays.push_back({eye, scaled_direction(glm::dvec3(random.point(1.5f) - eye))});
  }
  for (const Ray& ray : rays) {
    const auto primitive = nearest(bvh, ray);
    if (!primitive) continue;
    questions.push_back(
        {&ray, *primitive,
         questions.size() % 3 == 0 ? SpawnSide::kTransmitted : SpawnSide::kIncident});
  }
  ASSERT_GT(questions.size(), 1000u);
  std::vector<SpawnOrigin> expected;
  for (const SpawnQuery& q : questions) {
    const UsingVectors using_vectors(Vectors::kBaseline);
    expected.push_back(spawner.find(*q.ray, q.primitive, q.side));
  }
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors using_vectors(vectors);
    std::vector<SpawnOrigin> origins(questions.size());
    spawner.find(questions, origins);
    for (std::size_t i = 0; i < questions.size(); ++i) {
      ASSERT_EQ(bool(origins[i]), bool(expected[i])) << name_of(vectors) << " " << i;
      if (!expected[i]) continue;
      ASSERT_EQ(*origins[i], *expected[i]) << name_of(vectors) << " " << i;
    }
  }
}

TEST(RaySpawner, StaysWithinTheBoundOnBothSides) {
  Random random;
  double farthest = 0.0;
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 far = random.below(2) == 0 ? glm::vec3(0) : random.point(1000.0f);
    const Corners t = {random.point() + far, random.point() + far, random.point() + far};
    const glm::vec3 origin = random.point() + far;
    const glm::vec3 w(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    const glm::dvec3 aim = (glm::dvec3(t[0]) * double(w.x) + glm::dvec3(t[1]) * double(w.y) +
                            glm::dvec3(t[2]) * double(w.z)) /
                           (double(w.x) + double(w.y) + double(w.z));
    const Ray ray = {origin, scaled_direction(aim - glm::dvec3(origin))};
    if (!hits_triangle(ray, t)) continue;
    ++hits;
    const Bvh bvh(test::scene_of({t}));
    const NeighborClearances clearances(bvh);
    RaySpawner spawner(clearances);
    for (const SpawnSide way : {SpawnSide::kIncident, SpawnSide::kTransmitted}) {
      const auto point = spawner.find(ray, 0, way);
      ASSERT_TRUE(point);
      const int side = orient3d(origin, t);
      ASSERT_EQ(orient3d(*point, t), way == SpawnSide::kIncident ? side : -side);
      farthest = std::max(farthest, steps_between(*point, ray, t));
      // The continued ray, from the transmitted side, never hits the triangle again.
      ASSERT_TRUE(spawner.leaves(ray, 0, SpawnSide::kTransmitted, ray.direction));
      ASSERT_FALSE(spawner.leaves(ray, 0, SpawnSide::kIncident, ray.direction));
      ASSERT_EQ(hits_triangle({*point, ray.direction}, t) && way == SpawnSide::kTransmitted, false);
    }
  }
  EXPECT_GT(hits, 10000);
  EXPECT_LE(farthest, 3.0);
  std::cout << "farthest " << farthest << " floats\n";
}

/// Returns the distance of a point from a segment.
double distance(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b) {
  const double t = std::clamp(glm::dot(x - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(x - a - t * (b - a));
}

/// Returns the distance of a point from a triangle.
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

/// Returns a distance from x within which there is no overlap; 0 if even tiny distances have one.
double reach_beyond(const Overlaps& overlaps, const glm::dvec3& x) {
  float reach = 1.0f;
  while (reach > 0.0f && is_near(overlaps, glm::vec3(x), reach)) reach *= 0.5f;
  return reach;
}

/// Checks the normal, the corner and the gradients of a clearance against its triangle.
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
  int points = 0;  // on all triangles
  int free = 0;    // on triangles without overlaps
};

/// Checks the clearance at points of each triangle, most of them near its border.
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
    // Some triangles are separate, some share an edge or a vertex, some are flat.
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

// All triangles of a fan are near each other; the clearance search ends early.
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

// A triangle stands on another one, like a table's leg on the floor.
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

// A triangle above another one is an overlap only if it is very near.
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
