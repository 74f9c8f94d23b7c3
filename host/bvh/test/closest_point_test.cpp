// Compares closest points and box queries with a search of every triangle.
#include "host/bvh/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

TEST(ClosestPoint, OfOneTriangleByItsRegions) {
  const Bvh bvh(test::scene_of({{glm::vec3(0, 0, 0), glm::vec3(4, 0, 0), glm::vec3(0, 4, 0)}}));
  const auto at = [&](const glm::dvec3& point) { return closest_point(bvh, point).point; };
  EXPECT_EQ(at({1, 1, 7}), glm::dvec3(1, 1, 0));
  EXPECT_EQ(at({1, 1, 0}), glm::dvec3(1, 1, 0)) << "on it";
  EXPECT_EQ(at({-1, -2, 3}), glm::dvec3(0, 0, 0));
  EXPECT_EQ(at({9, -2, 3}), glm::dvec3(4, 0, 0));
  EXPECT_EQ(at({-1, 9, 3}), glm::dvec3(0, 4, 0));
  EXPECT_EQ(at({1, -2, 3}), glm::dvec3(1, 0, 0));
  EXPECT_EQ(at({-2, 1, 3}), glm::dvec3(0, 1, 0));
  EXPECT_EQ(at({4, 4, 3}), glm::dvec3(2, 2, 0));
  EXPECT_EQ(closest_point(bvh, {1, -3, 4}).distance, 5.0);
}

// Distances from a sliver of height h and from its longest side differ by up to h.
TEST(ClosestPoint, OfSlivers) {
  test::Random random;
  const auto point = [&] { return glm::dvec3(random.point()); };
  for (int i = 0; i < 2000; ++i) {
    const double height = std::ldexp(1.0, -20 - i % 25);
    const glm::dvec3 a = point(), b = point(), x = glm::mix(a, b, double{random.uniform(0, 1)});
    const glm::dvec3 c = glm::mix(a, b, double{random.uniform(0, 1)}) + height * unit(point());
    const glm::dvec3 from = x + std::ldexp(1.0, -random.below(40)) * point();
    const double share = std::clamp(glm::dot(from - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    const double distance = glm::distance(from, glm::mix(a, b, share));
    const Scene scene = test::scene_of({{a, b, c}});
    const ClosestPoint found = closest_point(Bvh(scene), from);
    ASSERT_NEAR(found.distance, distance, height + 0x1p-48) << height;
  }
}

TEST(ClosestPoint, IsTheLeastOfAll) {
  test::Random random;
  const std::vector<Corners> triangles = test::sphere(3);
  const Bvh bvh(test::scene_of(triangles));
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 point(random.point(i % 5 == 0 ? 100.0f : 2.0f));
    const ClosestPoint found = closest_point(bvh, point);
    std::uint32_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t k = 0; k < triangles.size(); ++k) {
      const Bvh alone(test::scene_of({triangles[k]}));
      const double distance = closest_point(alone, point).distance;
      if (distance < least) std::tie(least, nearest) = std::pair(distance, k);
    }
    ASSERT_EQ(found.distance, least);
    ASSERT_EQ(bvh.triangle_of(found.primitive), nearest);
    ASSERT_EQ(glm::distance(found.point, point), found.distance);
  }
}

TEST(ClosestPoint, OfFarPointsIsTheFarthestInTheirDirection) {
  test::Random random;
  const std::vector<Corners> triangles = test::sphere(3);
  const Bvh bvh(test::scene_of(triangles));
  for (const double far : {0x1p26, 0x1p28, 0x1p60, 0x1p1000}) {
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 direction = unit(glm::dvec3(random.point(1.0f)));
      const ClosestPoint found = closest_point(bvh, far * direction);
      double most = -1.0;
      for (const Corners& triangle : triangles) {
        for (const glm::dvec3& corner : triangle) {
          most = std::max(most, glm::dot(direction, glm::dvec3(corner)));
        }
      }
      ASSERT_NEAR(glm::dot(direction, found.point), most, 0x1p-24);
      ASSERT_NEAR(found.distance, far - most, 0x1p-51 * far);
    }
  }
}

std::vector<std::uint32_t> primitives_near(const Bvh& bvh, const glm::vec3& low,
                                           const glm::vec3& high) {
  std::vector<std::uint32_t> primitives;
  EXPECT_FALSE(
      any_primitive_near(bvh, low, high, [&](std::uint32_t primitive, const Corners& corners) {
        EXPECT_EQ(corners, bvh.corners_of(primitive));
        primitives.push_back(primitive);
        return false;
      }));
  if (primitives.empty()) return primitives;
  std::size_t left = primitives.size() / 2;
  const auto end = [&](std::uint32_t, const Corners&) { return left-- == 0; };
  EXPECT_TRUE(any_primitive_near(bvh, low, high, end)) << "it can be ended";
  return primitives;
}

TEST(BoxQuery, FindsWhatTouchesAndNothingElse) {
  test::Random random;
  const Bvh bvh(test::scene_of(test::sphere(3)));
  std::vector<std::uint32_t> found;
  std::size_t total = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p = random.point(), q = p + random.point(0.3f);
    const glm::vec3 low = glm::min(p, q), high = glm::max(p, q);
    found = primitives_near(bvh, low, high);
    std::ranges::sort(found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
      const FloatCorners t = bvh.float_corners_of(primitive);
      bool touches = true;
      for (int k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
        touches = touches && least <= high[k] && low[k] <= most;
      }
      if (touches) expected.push_back(primitive);
    }
    ASSERT_EQ(found, expected);
    total += found.size();
  }
  EXPECT_GT(total, 1000u);
}

// Boxes are closed: a box of size 0 at a vertex touches all triangles around the vertex.
TEST(BoxQuery, APointTouchesTheTrianglesThatEndThere) {
  const std::vector<Corners> mesh = test::sphere(2);
  const Bvh bvh(test::scene_of(mesh));
  std::vector<std::uint32_t> found;
  for (const Corners& t : mesh) {
    found = primitives_near(bvh, t[0], t[0]);
    EXPECT_GE(found.size(), 5u);
  }
}

TEST(BoxQuery, AnEmptySceneHasNothing) {
  const Bvh bvh(test::scene_of({}));
  std::vector<std::uint32_t> found = {7};
  found = primitives_near(bvh, glm::vec3(-1), glm::vec3(1));
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace raygate
