// Computes smooth vertex normals of faces that have none.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "host/scene/scene.h"

namespace raygate {

/// Whether triangles get smooth normals that equal their geometric normal.
enum class FlatFaces { kHaveNormals, kStayFlat };

/// Sets the normals of triangles that have none and have a smooth edge. The normal at a corner is
/// the weighted mean over the triangles that are connected there by smooth edges (weights of N.
/// Max, "Weights for computing vertex normals from facet normals", Journal of Graphics Tools 4 (2),
/// 1999; exact on spheres). An edge is smooth if exactly two such triangles share it, with equal
/// positions and in opposite directions, and
/// * the angle between their normals is at most `angle`, in degrees up to 180, if that is given;
/// * otherwise they have the same group in `groups`, other than 0.
void add_smooth_normals(std::span<const std::uint32_t> groups, std::optional<double> angle,
                        Scene& scene, FlatFaces flat = FlatFaces::kHaveNormals);

}  // namespace raygate
