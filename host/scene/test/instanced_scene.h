// A scene with instances, for the tests of all code that handles instances.
#pragma once

#include <utility>

#include "host/exact/test/meshes.h"
#include "host/scene/instances.h"

namespace raygate::test {

/// Returns an instance with a random linear transform, whose coefficients are at most about `size`,
/// and translation `at`.
inline Instance placed_at_random(Random& random, const glm::vec3& at, float size) {
  Instance instance;
  do {
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 row = random.point(size);
      for (int axis = 0; axis < 3; ++axis) instance.rows[k][axis] = row[axis];
      instance.rows[k][3] = at[k];
    }
    const auto& m = instance.rows;
    const glm::dvec3 x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
        z(m[2][0], m[2][1], m[2][2]);
    if (glm::dot(glm::cross(x, y), z) > 0.01 * size * size * size) return instance;
  } while (true);
}

/// Returns a scene of `count` overlapping instances within 3 of the origin, alternately spheres
/// (with normals) and boxes, inside a box of plain triangles. Three further instances are boxes:
/// the first shares a side with the other two, which coincide.
inline Scene instanced_scene(Random& random, int count) {
  Scene scene = scene_of(box(glm::vec3(-4), glm::vec3(4)));
  Scene ball = scene_of(sphere(2));
  ball.materials.clear();
  for (Triangle& triangle : ball.triangles) triangle.normals = triangle.vertices;
  ball.normals = ball.positions;
  Scene cube = scene_of(box(glm::vec3(0), glm::vec3(1)));
  cube.materials.clear();
  const std::uint32_t meshes[] = {add_mesh(scene, std::move(ball)),
                                  add_mesh(scene, std::move(cube))};
  for (int i = 0; i < count; ++i) {
    Instance& instance = scene.instances.emplace_back(
        placed_at_random(random, random.point(3.0f), random.uniform(0.1f, 1.0f)));
    instance.mesh = meshes[i % 2];
    instance.object = static_cast<std::uint32_t>(i + 1);
    scene.objects.push_back("instance " + std::to_string(i));
  }
  for (const double x : {0.0, 1.0, 1.0}) {
    Instance& instance = scene.instances.emplace_back();
    instance.mesh = meshes[1];
    instance.rows[0][3] = x;
  }
  return scene;
}

/// Returns the scene with its instances flattened.
inline Scene written_out(Scene scene) {
  resolve_instances(scene, InstanceMode::kFlatten, "written out");
  return scene;
}

}  // namespace raygate::test
