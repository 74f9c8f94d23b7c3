#include "host/scene/bounds.h"

#include <array>
#include <utility>

namespace raygate {
namespace {

/// Expands the box by the positions of all instances. Skips meshes whose bounds are inside it.
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

// The extremes of a coordinate are at corners of the box even with rounding, as each operation of
// transform_coordinate is monotonic in its operands.
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

std::vector<OpenEdge> open_edges(const Scene& scene) {
  using Ends = std::array<double, 6>;
  std::vector<std::pair<Ends, int>> edges;  // the smaller end first; 1 or -1: its direction
  for_each_face(scene, [&](const Corners& t, const Triangle&) {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
      const Ends ends{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
      edges.emplace_back(std::min(ends, back), back < ends ? -1 : 1);
    }
  });
  std::ranges::sort(edges);
  std::vector<OpenEdge> open;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    int times = 0;
    for (end = i; end < edges.size() && edges[end].first == edges[i].first; ++end) {
      times += edges[end].second;
    }
    const auto& [ax, ay, az, bx, by, bz] = edges[i].first;
    if (times > 0) open.push_back({{ax, ay, az}, {bx, by, bz}, static_cast<double>(times)});
    if (times < 0) open.push_back({{bx, by, bz}, {ax, ay, az}, static_cast<double>(-times)});
  }
  return open;
}

}  // namespace raygate
