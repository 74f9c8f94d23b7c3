// Bounding boxes of scenes, with their instances, and a visitor of their triangles.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "host/exact/exact.h"
#include "host/scene/instances.h"
#include "host/scene/scene.h"

namespace raygate {

/// An axis-aligned box; empty until it is expanded.
struct Bounds3 {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void expand(const glm::dvec3& position) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  }
  [[nodiscard]] bool is_empty() const { return low.x > high.x; }
  [[nodiscard]] glm::dvec3 middle() const { return 0.5 * (low + high); }
  [[nodiscard]] glm::dvec3 half_size() const { return 0.5 * (high - low); }
};

[[nodiscard]] Bounds3 bounds_of(std::span<const glm::vec3> positions);

/// Returns the tightest box around the image of `box` under an instance transform.
[[nodiscard]] Bounds3 transform_bounds(const double (&rows)[3][4], const Bounds3& box);

/// Returns the bounds of the corners of all triangles, including those of instances.
[[nodiscard]] Bounds3 triangle_bounds(const Scene& scene);
/// Returns the bounds of all positions, including unreferenced ones and those of instances.
[[nodiscard]] Bounds3 position_bounds(const Scene& scene);

/// Returns whether the scene has neither instances nor triangles with an area.
[[nodiscard]] inline bool is_empty(const Scene& scene) {
  return scene.instances.empty() && std::ranges::all_of(scene.triangles, is_left_out);
}

/// Calls visit(corners, triangle) for all triangles of the scene and of its instances, in the order
/// of their indices. Skips triangles without area.
template <class Visit>
void for_each_face(const Scene& scene, const Visit& visit) {
  const auto visit_all = [&](const std::vector<Triangle>& triangles, const auto& position_of) {
    Corners corners;
    for (const Triangle& face : triangles) {
      if (is_left_out(face)) continue;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = position_of(face.vertices[k]);
      visit(corners, face);
    }
  };
  visit_all(scene.triangles, [&](std::uint32_t vertex) { return scene.vertex(vertex); });
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    visit_all(mesh.triangles, [&](std::uint32_t vertex) {
      return glm::dvec3(transform_point(instance.rows, mesh.positions[vertex]));
    });
  }
}

}  // namespace raygate
