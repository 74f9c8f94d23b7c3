// What every scene that was loaded must be.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "host/exact/exact.h"
#include "host/scene/scene.h"

namespace raygate::test {

/// Finite positions, indices of something, unit normals, triangles that have an area.
inline void expect_sound(const Scene& scene) {
  ASSERT_FALSE(scene.triangles.empty());
  for (const glm::vec3& p : scene.positions) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  for (const Triangle& triangle : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LT(triangle.vertices[k], scene.positions.size());
      if (triangle.normals[k] != kNoIndex) {
        ASSERT_LT(triangle.normals[k], scene.normals.size());
        ASSERT_NEAR(glm::length(scene.normals[triangle.normals[k]]), 1.0f, 1e-6f);
      }
      if (triangle.texcoords[k] != kNoIndex) {
        ASSERT_LT(triangle.texcoords[k], scene.texcoords.size());
      }
    }
    const auto& [a, b, c] = triangle.vertices;
    const FloatCorners corners{scene.positions[a], scene.positions[b], scene.positions[c]};
    ASSERT_TRUE(is_left_out(triangle) || triangle_normal(widened(corners)) != glm::dvec3(0.0));
    ASSERT_LT(triangle.material, scene.materials.size());
    ASSERT_LT(triangle.object, scene.objects.size());
  }
}

}  // namespace raygate::test
