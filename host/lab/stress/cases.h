// Cases of the stress test: rays with a common origin at a few triangles, their exact results,
// closed meshes, and generators of hard cases. Shares no code with the renderer.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
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
  /// Returns a number from `low` to `high` whose logarithm is uniformly distributed.
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

  // Format of coordinates: binary32, or binary64 on multiples of 2^-149.
  bool binary64_vertices = false, binary64_rays = false;
  [[nodiscard]] glm::dvec3 vertex(const glm::dvec3& p) const {
    return rounded(p, binary64_vertices);
  }
  [[nodiscard]] glm::dvec3 origin(const glm::dvec3& p) const { return rounded(p, binary64_rays); }
  [[nodiscard]] static glm::dvec3 rounded(const glm::dvec3& p, bool to_binary64);

 private:
  std::mt19937_64 engine_;
};

using Corners = std::array<glm::dvec3, 3>;  ///< the vertices of a triangle
using Mesh = std::vector<Corners>;
using MeshPointer = std::shared_ptr<const Mesh>;

/// A test of each ray against each triangle of a mesh.
struct Shot {
  MeshPointer mesh;  ///< several shots may share a mesh
  glm::dvec3 origin{0.0};
  std::vector<glm::dvec3> directions{};  ///< 1 to 8, scaled as the renderer scales them
  bool inside = false;                   ///< the mesh is closed and contains the origin

  /// Returns the number of tests. Results are ordered by ray, then by triangle.
  [[nodiscard]] std::size_t tests() const { return directions.size() * mesh->size(); }
};

/// The exact result for one ray and one triangle.
struct Verdict {
  bool hit = false;
  bool tie = false;   ///< the ray meets the line of an edge exactly: the tie-break decides
  double t = 0.0;     ///< of a hit; relative error at most 2^-50
  double sine = 0.0;  ///< of a hit: sine of the angle between ray and plane; same error
};

struct Truth {
  std::vector<Verdict> verdicts;  ///< by ray, then by triangle
  /// For each ray, the triangles that it hits, in exact order: nearest first, ties by index.
  std::vector<std::vector<std::uint32_t>> orders;
  /// By ray: whether two of its hits have equal distance, or the tie-break was used.
  std::vector<bool> nearest_tied;

  /// Returns the triangle that a ray hits first.
  [[nodiscard]] std::optional<std::uint32_t> nearest(std::size_t ray) const {
    return orders[ray].empty() ? std::nullopt : std::optional(orders[ray].front());
  }
};

/// Computes the results by definition: all coordinates are integer multiples of a power of two, so
/// the determinants are integers. With A, B, C the vertices minus the origin, a ray of direction I
/// hits if D = A . (B x C) is not 0, and I . (A x B), I . (B x C), I . (C x A) have D's sign. If a
/// product with I is 0, its sign is that of the first non-zero component of the cross product, as
/// if I were tilted by (e, e^2, e^3) with tiny e > 0. Zero, infinite and NaN directions miss.
[[nodiscard]] Truth find_truth(const Shot& shot);

/// Position of a mesh made around the origin at size 1: p becomes p * scale + shift, rounded.
struct Placement {
  glm::dvec3 scale{1.0}, shift{0.0};
  bool binary64 = false;
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
  bool binary64 = false;  ///< vertices are binary64; in half of the shots, rays, too
};

/// Returns all suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& all_suites();

}  // namespace raygate::lab
