// Closed meshes: neighbours share their vertices bit for bit.
#pragma once

#include <memory>

#include "host/lab/stress/random.h"
#include "host/lab/stress/shot.h"

namespace raygate::lab {

/// Where a mesh made around the origin at size 1 is put: p goes to p * scale + shift, rounded once.
struct Placement {
  glm::dvec3 scale{1.0}, shift{0.0};
};

using MeshPointer = std::shared_ptr<const Mesh>;

[[nodiscard]] MeshPointer box(const Placement& placement = {});
/// An icosahedron whose triangles are cut in four `level` times.
[[nodiscard]] MeshPointer sphere(int level, const Placement& placement = {});
/// `points` random points of the unit sphere and its Delaunay triangulation (on the sphere), but
/// for rounding; slivers among its triangles.
[[nodiscard]] MeshPointer random_sphere(int points, Random& random,
                                        const Placement& placement = {});
/// A prism along z between x = 0 and 1 whose side faces meet in the z axis, in an angle of about
/// `angle` rad.
[[nodiscard]] MeshPointer wedge(double angle, const Placement& placement = {});

}  // namespace raygate::lab
