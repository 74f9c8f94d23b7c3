// Smooth vertex normals for faces that have no normals of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "host/scene/scene.h"

namespace raygate {

/// What becomes of a triangle whose smooth normals are all its own, as in a plane.
enum class FlatFaces { kHaveNormals, kStayFlat };

/// Gives normals to triangles that have none, where they are smooth: at a corner each has the mean
/// of all that come together there over smooth edges, weighted as N. Max says ("Weights for
/// computing vertex normals from facet normals", Journal of Graphics Tools 4 (2), 1999: exact on
/// spheres). An edge is smooth if just two of these triangles share it, by the places of its ends,
/// in opposite directions, and
/// * `angle` is given, in degrees up to 180: their normals are at most so far apart;
/// * or else, by `groups` of the triangles: they are of one group, and not of group 0.
/// Triangles without a smooth edge stay as they are, and so do flat ones where `flat` says so.
void add_smooth_normals(std::span<const std::uint32_t> groups, std::optional<double> angle,
                        Scene& scene, FlatFaces flat = FlatFaces::kHaveNormals);

}  // namespace raygate
