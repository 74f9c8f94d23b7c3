// Shots of the stress test: rays with a common origin at a few triangles; failures as text.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <string>
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

/// One ray and the triangles it is tested against: what a failure comes down to.
struct Case {
  glm::vec3 origin{0.0f}, direction{0.0f};
  std::vector<Corners> triangles;
};

/// A line of test/regressions.txt: words in hex, origin, direction, the triangles' vertices.
[[nodiscard]] std::string to_text(const Case& failure);

/// And back; std::invalid_argument where the line is no case.
[[nodiscard]] Case case_from(const std::string& line);

/// As something to shoot at.
[[nodiscard]] Shot shot_of(const Case& failure);

}  // namespace raygate::lab
