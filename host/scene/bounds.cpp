#include "host/scene/bounds.h"

namespace raygate {
namespace {

/// Expands `box` by the positions of all instances. Skips instances whose bounds are inside `box`.
void expand_by_instances(const Scene& scene, Bounds3& box) {
  std::vector<Bounds3> mesh_bounds;
  mesh_bounds.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) mesh_bounds.push_back(bounds_of(mesh.positions));
  for (const Instance& instance : scene.instances) {
    const Bounds3 whole = transform_bounds(instance.rows, mesh_bounds[instance.mesh]);
    // Rounding to float is monotonic, so instances within the box need not be visited.
    if (glm::all(glm::lessThanEqual(box.low, glm::dvec3(glm::vec3(whole.low)))) &&
        glm::all(glm::lessThanEqual(glm::dvec3(glm::vec3(whole.high)), box.high))) {
      continue;
    }
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
      box.expand(transform_point(instance.rows, position));
    }
  }
}

}  // namespace

Bounds3 bounds_of(std::span<const glm::vec3> positions) {
  Bounds3 box;
  for (const glm::vec3& position : positions) box.expand(position);
  return box;
}

// The extremes of a coordinate are at corners of the box even with rounding, because each operation
// of transform_coordinate is monotonic in its operands.
Bounds3 transform_bounds(const double (&rows)[3][4], const Bounds3& box) {
  Bounds3 result;
  for (int k = 0; k < 3; ++k) {
    const auto& row = rows[k];
    double low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_turned = row[axis] < 0.0;
      low[axis] = is_turned ? box.high[axis] : box.low[axis];
      high[axis] = is_turned ? box.low[axis] : box.high[axis];
    }
    transform_coordinate(row, low, result.low[k]);
    transform_coordinate(row, high, result.high[k]);
  }
  return result;
}

Bounds3 triangle_bounds(const Scene& scene) {
  Bounds3 box;
  for (const Triangle& triangle : scene.triangles) {
    if (is_left_out(triangle)) continue;
    for (const std::uint32_t vertex : triangle.vertices) box.expand(scene.positions[vertex]);
  }
  expand_by_instances(scene, box);
  return box;
}

Bounds3 position_bounds(const Scene& scene) {
  Bounds3 box = bounds_of(scene.positions);
  expand_by_instances(scene, box);
  return box;
}

}  // namespace raygate
