// Closest points against a look at every triangle, and where they are known.
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
        for (const glm::vec3& corner : triangle) {
          most = std::max(most, glm::dot(direction, glm::dvec3(corner)));
        }
      }
      ASSERT_NEAR(glm::dot(direction, found.point), most, 0x1p-24);
      ASSERT_NEAR(found.distance, far - most, 0x1p-51 * far);
    }
  }
}

}  // namespace
}  // namespace raygate
