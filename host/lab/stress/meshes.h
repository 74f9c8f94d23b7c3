// Closed meshes: neighbouring triangles share their vertices bit for bit.
#pragma once

#include <memory>

#include "host/lab/stress/random.h"
#include "host/lab/stress/shot.h"

namespace raygate::lab {

/// Position of a mesh made around the origin at size 1: p becomes p * scale + shift, rounded once.
struct Placement {
  glm::dvec3 scale{1.0}, shift{0.0};
};

using MeshPointer = std::shared_ptr<const Mesh>;

[[nodiscard]] MeshPointer box(const Placement& placement = {});
/// Returns an icosahedron whose triangles are subdivided into four, `level` times.
[[nodiscard]] MeshPointer sphere(int level, const Placement& placement = {});
/// Returns the spherical Delaunay triangulation of `points` random points of the unit sphere, up to
/// rounding. Some triangles are slivers.
[[nodiscard]] MeshPointer random_sphere(int points, Random& random,
                                        const Placement& placement = {});
/// Returns a prism along z between x = 0 and 1 with an angle of about `angle` rad at the z axis.
[[nodiscard]] MeshPointer wedge(double angle, const Placement& placement = {});

}  // namespace raygate::lab
