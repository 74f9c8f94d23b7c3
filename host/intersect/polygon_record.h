// Polygon record: one triangle seen from one origin, the 64 bytes that a hit test reads.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "host/exact/exact.h"

namespace raygate {

/// The 16 words of a triangle A, B, C seen from an origin O (A, B, C are the vertices minus O). All
/// rays from O share it.
///
/// Words are results of double or exact arithmetic, rounded once to float. (N, d), and each edge
/// with its bound, are scaled by a power of two if their exponents are outside [-60, 60]; this
/// changes neither P nor any sign. All words are finite, except that a bound can be +infinity: that
/// edge is then always in doubt.
struct alignas(64) PolygonRecord {
  glm::vec3 normal{0.0f};            ///< words 0-2: N = (B-A) x (C-A), the paper's H
  float d = 0.0f;                    ///< word 3: N . A; its sign is exact, and 0 is exactly 0
  std::array<glm::vec3, 3> edges{};  ///< words 4-12: A x B, B x C, C x A; for a shared edge the
                                     ///< two triangles hold exactly opposite numbers
  std::array<float, 3> bounds{};     ///< words 13-15: |float32(I . E) - exact| < bound, for every
                                     ///< I with components of magnitude under 2
};
static_assert(sizeof(PolygonRecord) == 64);

/// The bound of an edge E is kEdgeBound 2^-24 |E|_1 (derivation in polygon_record.cpp).
inline constexpr double kEdgeBound = 8.0 + 0x1p-7;

/// Returns the record of a triangle for rays from `origin`. All coordinates are finite with a
/// magnitude of at most 2^126. If the origin is in the triangle's plane, or the triangle has no
/// area, d is 0 and no ray hits it.
[[nodiscard]] PolygonRecord make_record(const glm::vec3& origin, const Corners& triangle);

/// Returns only the plane: words 0-3 of that record; the others are 0.
[[nodiscard]] PolygonRecord make_plane(const glm::vec3& origin, const Corners& triangle);

/// Sets records[i] to make_record(origin, triangles[i]), bit for bit. The spans have the same size.
void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records);

/// Number of planes that make_planes makes at once.
inline constexpr int kPlanes = 4;

/// Triangles and the origins from which they are seen.
struct PlaneViews {
  glm::vec3 origins[kPlanes];
  Corners triangles[kPlanes];
};

/// N and d of the results of make_plane, lane by lane.
struct Planes {
  alignas(16) float words[4][kPlanes];
};

/// Sets lane i to make_plane(views.origins[i], views.triangles[i]), bit for bit.
void make_planes(const PlaneViews& views, Planes& planes);

}  // namespace raygate
