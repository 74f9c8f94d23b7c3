// What the stress test shoots: rays with a common origin at a few triangles.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace raygate::lab {

using Corners = std::array<glm::vec3, 3>;  ///< the vertices of a triangle

struct Mesh {
  std::vector<Corners> triangles;
  bool closed = false;  ///< each edge belongs to two triangles that run through it in opposite ways
};

/// Each ray of a shot is tested against each triangle of its mesh.
struct Shot {
  std::shared_ptr<const Mesh> mesh;  ///< shots may share it
  glm::vec3 origin{0.0f};
  std::vector<glm::vec3> directions;  ///< 1 to 8, scaled as the renderer scales them
  bool inside = false;                ///< the mesh is closed, and the origin within

  /// Shots have so many results of each kind: ray by ray, triangle by triangle.
  [[nodiscard]] std::size_t tests() const { return directions.size() * mesh->triangles.size(); }
};

}  // namespace raygate::lab
