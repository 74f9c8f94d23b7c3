#include "host/scene/io/mesh_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace raygate {
namespace {

TEST(OriginForBox, IsZeroNearTheOrigin) {
  EXPECT_EQ(origin_for_box({0, 0, 0}, {556, 548.8, 559.2}), glm::dvec3(0));
  EXPECT_EQ(origin_for_box({-1, -1, -1}, {1, 1, 1}), glm::dvec3(0));
  EXPECT_EQ(origin_for_box({5, 5, 5}, {5, 5, 5}), glm::dvec3(5));
}

TEST(OriginForBox, LosesNoBitFarAway) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 100000; ++round) {
    const double size = std::ldexp(1.0, static_cast<int>(random() % 40) - 20);
    const glm::dvec3 centre = size * std::ldexp(1.0, static_cast<int>(random() % 30)) *
                              glm::dvec3(uniform(random), uniform(random), uniform(random));
    glm::dvec3 points[4];
    for (glm::dvec3& p : points) {
      p = centre + size * glm::dvec3(uniform(random), uniform(random), uniform(random));
    }
    glm::dvec3 low = points[0], high = points[0];
    for (const glm::dvec3& p : points) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const glm::dvec3 origin = origin_for_box(low, high);
    const glm::dvec3 extent = high - low;
    const double largest = std::max({extent.x, extent.y, extent.z});
    for (const glm::dvec3& p : points) {
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_LE(std::abs(p[axis] - origin[axis]), 3.0 * largest) << "round " << round;
        if (std::abs(p[axis]) < 3.0 * largest) continue;
        // Two-sum gives the rounding error of the subtraction.
        const double difference = p[axis] - origin[axis];
        const double back = difference - p[axis];
        const double error = (p[axis] - (difference - back)) + (-origin[axis] - back);
        ASSERT_EQ(error, 0.0) << "round " << round;
      }
    }
  }
}

TEST(OriginForBox, StaysFinite) {
  const double huge = std::numeric_limits<float>::max();
  for (const auto& [low, high] : {std::pair(-huge, huge), std::pair(0.5 * huge, huge),
                                  std::pair(0.1 * huge, huge), std::pair(-huge, -0.9 * huge)}) {
    const glm::dvec3 origin = origin_for_box(glm::dvec3(low), glm::dvec3(high));
    EXPECT_LE(std::abs(low - origin.x), huge);
    EXPECT_LE(std::abs(high - origin.x), huge);
  }
  EXPECT_EQ(origin_for_box({huge, 0, 0}, {huge, 1e-300, 0}).x, huge);
}

TEST(MeshBuilder, KeepsWhatFacesUse) {
  MeshBuilder builder("m.obj");
  for (int i = 0; i < 5; ++i) builder.add_position({i, i * i, 0});
  const FaceCorner corners[]{{1}, {4}, {3}};
  builder.add_face(corners, 1, {.material = 7, .object = 3});
  Scene scene;
  builder.build({}, scene);
  EXPECT_EQ(scene.positions, (std::vector<glm::vec3>{{1, 1, 0}, {3, 9, 0}, {4, 16, 0}}));
  ASSERT_EQ(scene.triangles.size(), 1u);
  EXPECT_EQ(scene.triangles[0].vertices, (std::array<std::uint32_t, 3>{0, 2, 1}));
  EXPECT_EQ(scene.triangles[0].material, 7u);
  EXPECT_EQ(scene.triangles[0].object, 3u);
}

}  // namespace
}  // namespace raygate
