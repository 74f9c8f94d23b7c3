// Cases of the stress test: rays with a common origin at a few triangles, closed meshes, and
// generators of hard cases.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace raygate::lab {

/// Random numbers for generators: the same on every machine for the same seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Returns a number whose logarithm is uniformly distributed.
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  double sign() { return one_in(2) ? 1.0 : -1.0; }
  /// Returns a point in the cube from -1 to 1.
  glm::dvec3 point() {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    return {x, y, z};
  }
  glm::dvec3 unit() {
    for (;;) {
      const glm::dvec3 p = point();
      const double square = glm::dot(p, p);
      if (square > 0.01 && square < 1.0) return p / std::sqrt(square);
    }
  }

 private:
  std::mt19937_64 engine_;
};

using Corners = std::array<glm::vec3, 3>;  ///< the vertices of a triangle
using Mesh = std::vector<Corners>;
using MeshPointer = std::shared_ptr<const Mesh>;

/// A test of each ray against each triangle of a mesh.
struct Shot {
  MeshPointer mesh;  ///< shots may share it
  glm::vec3 origin{0.0f};
  std::vector<glm::vec3> directions{};  ///< 1 to 8, scaled as the renderer scales them
  bool inside = false;                  ///< the mesh is closed and contains the origin

  /// Returns the number of results of each kind, ordered by ray, then by triangle.
  [[nodiscard]] std::size_t tests() const { return directions.size() * mesh->size(); }
};

/// Position of a mesh made around the origin at size 1: p becomes p * scale + shift.
struct Placement {
  glm::dvec3 scale{1.0}, shift{0.0};
};

// Closed meshes: neighbouring triangles share their vertices bit for bit.
[[nodiscard]] MeshPointer box(const Placement& placement = {});
/// Returns an icosahedron whose triangles are subdivided into four, `level` times.
[[nodiscard]] MeshPointer sphere(int level, const Placement& placement = {});
/// Returns the spherical Delaunay triangulation of random points of the unit sphere: their convex
/// hull. Some triangles are slivers.
[[nodiscard]] MeshPointer random_sphere(int points, Random& random,
                                        const Placement& placement = {});
/// Returns a prism along z between x = 0 and 1 with an angle of about `angle` rad at the z axis.
[[nodiscard]] MeshPointer wedge(double angle, const Placement& placement = {});

using Generator = std::function<Shot(Random&)>;

/// Hard cases for one kind of failure of hit tests.
struct Suite {
  std::string name;
  std::string what;  ///< one line for the report
  /// Makes a generator with its own state.
  std::function<Generator()> make;
};

/// Returns all suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& all_suites();

}  // namespace raygate::lab
