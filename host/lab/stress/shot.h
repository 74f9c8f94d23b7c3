// Shots of the stress test: rays with a common origin at a few triangles; and failures as text.
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
  /// Each edge belongs to two triangles that traverse it in opposite directions.
  bool closed = false;
};

/// A test of each ray against each triangle of a mesh.
struct Shot {
  std::shared_ptr<const Mesh> mesh;  ///< shots may share it
  glm::vec3 origin{0.0f};
  std::vector<glm::vec3> directions;  ///< 1 to 8, scaled as the renderer scales them
  bool inside = false;                ///< the mesh is closed and contains the origin

  /// Returns the number of results of each kind, ordered by ray, then by triangle.
  [[nodiscard]] std::size_t tests() const { return directions.size() * mesh->triangles.size(); }
};

/// A ray and the triangles that it is tested against, to which a failure is reduced.
struct Case {
  glm::vec3 origin{0.0f}, direction{0.0f};
  std::vector<Corners> triangles;
};

/// Returns a line of test/regressions.txt: hexadecimal words of origin, direction and vertices.
[[nodiscard]] std::string to_text(const Case& failure);

/// Parses such a line. Throws std::invalid_argument if it is invalid.
[[nodiscard]] Case case_from(const std::string& line);

[[nodiscard]] Shot shot_of(const Case& failure);

}  // namespace raygate::lab
