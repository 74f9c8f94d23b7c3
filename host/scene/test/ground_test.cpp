#include <gtest/gtest.h>

#include <limits>

#include "host/scene/view.h"

namespace raygate {
namespace {

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
