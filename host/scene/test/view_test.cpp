// Default views, up axes and the ground.
#include "host/scene/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "host/scene/camera.h"

namespace raygate {
namespace {

constexpr glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

Scene box(const glm::vec3& low, const glm::vec3& high) {
  Scene scene;
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (int corner = 0; corner < 8; ++corner) {
    scene.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                 corner & 4 ? high.z : low.z);
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& [a, b, c, d] : kSides) {
    for (const auto& [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}}) {
      scene.triangles.emplace_back().vertices = {first + p, first + q, first + r};
    }
  }
  return scene;
}

glm::dvec3 towards_eye(const Scene& scene, const View& view) {
  const CameraSetting camera = frame_scene(scene, 1.5, 35, view);
  return glm::normalize(camera.eye - camera.target);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(View, StandsWhereItsAnglesSay) {
  const Scene scene = box({1, 2, 3}, {2, 5, 7});
  expect_near(towards_eye(scene, {0, 0, kY}), kZ);
  expect_near(towards_eye(scene, {90, 0, kY}), kX);
  expect_near(towards_eye(scene, {-90, 0, kY}), -kX);
  expect_near(towards_eye(scene, {180, 0, kY}), -kZ);
  expect_near(towards_eye(scene, {33, 90, kY}), kY);
  expect_near(towards_eye(scene, {0, -90, kY}), -kY);
  expect_near(towards_eye(scene, {0, 0, kZ}), -kY);
  expect_near(towards_eye(scene, {90, 0, kZ}), kX);
  expect_near(towards_eye(scene, {0, 90, kZ}), kZ);
  expect_near(towards_eye(scene, {0, 30, 1e-200 * kZ}), {0, -std::sqrt(0.75), 0.5});
  // Seen straight from above, the scene's front is at the bottom of the picture.
  expect_near(*frame_scene(scene, 1, 35, {0, 90, kY}).up, -kZ);
  expect_near(*frame_scene(scene, 1, 35, {0, 90, kZ}).up, kY);
}

/// Returns the largest distance of a box's corners from the picture's centre; 1: at an edge.
double reach(const Camera& camera, double aspect, const glm::dvec3& low, const glm::dvec3& high) {
  double result = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                           corner & 4 ? high.z : low.z);
    const glm::dvec3 way = point - glm::dvec3(camera.eye());
    const double half = glm::dot(way, camera.forward()) * camera.half_height();
    EXPECT_GT(half, 0.0);
    result = std::max({result, std::abs(glm::dot(way, camera.right())) / (half * aspect),
                       std::abs(glm::dot(way, camera.up())) / half});
  }
  return result;
}

TEST(View, FillsThePictureFromAllSides) {
  const std::uint64_t seed = 20240811;
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int round = 0; round < 300; ++round) {
    const glm::dvec3 low(uniform(random), uniform(random), uniform(random));
    const glm::dvec3 high =
        low + glm::exp(glm::dvec3(uniform(random), uniform(random), uniform(random)));
    const Scene scene = box(low, high);
    const View view = {360 * uniform(random), 90 * uniform(random),
                       round % 2 == 0   ? kY
                       : round % 4 == 1 ? kZ
                                        : -kX};
    const double aspect = std::exp(uniform(random));
    const Camera camera = Camera::look_at(frame_scene(scene, aspect, 35, view), aspect);
    EXPECT_NEAR(reach(camera, aspect, low, high), 0.96, 1e-4) << "round " << round;
  }
}

Scene tetrahedron(float size) {
  Scene scene;
  scene.positions = {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}, {1, 2, 4}};
  for (glm::vec3& position : scene.positions) position *= size;
  for (std::uint32_t k = 0; k < 4; ++k) {
    scene.triangles.emplace_back().vertices = {k, (k + 1) % 4, (k + 2) % 4};
  }
  scene.materials.resize(1);
  scene.objects = {"it"};
  return scene;
}

TEST(Ground, LiesUnderTheSceneAndLooksUp) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 up(0.0);
      up[axis] = 5 * sign;
      Scene scene = tetrahedron(1.0f);
      add_ground(scene, up);
      ASSERT_EQ(scene.triangles.size(), 6u);
      EXPECT_EQ(scene.objects[1], "ground");
      EXPECT_EQ(scene.materials[scene.triangles[5].material].illumination_model, 10);
      const double lowest = sign * (sign > 0 ? axis + 1 : axis + 2);
      for (const std::size_t face : {4u, 5u}) {
        glm::dvec3 corners[3];
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = scene.positions[scene.triangles[face].vertices[k]];
          EXPECT_LT(corners[k][axis] * sign, lowest);
          EXPECT_GT(corners[k][axis] * sign, lowest - 0.01);
        }
        EXPECT_GT(glm::cross(corners[1] - corners[0], corners[2] - corners[0])[axis] * sign, 0.0);
      }
    }
  }
}

TEST(Ground, IsLeftOutWhereFloatEnds) {
  Scene scene = tetrahedron(std::numeric_limits<float>::max() / 8);
  add_ground(scene, {0, 1, 0});
  EXPECT_EQ(scene.triangles.size(), 4u);
  EXPECT_EQ(scene.positions.size(), 4u);
  EXPECT_EQ(scene.objects.size(), 1u);
}

}  // namespace
}  // namespace raygate
