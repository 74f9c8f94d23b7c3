// The surface where a ray hits it: point, normals, and which side was hit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/exact/exact.h"
#include "host/scene/scene.h"
#include "host/tree/bvh.h"

namespace raygate {

/// How far off, of itself, the unit's P may be before the host computes the point, where nobody
/// says otherwise: rays that meet a surface at a flat angle are the host's.
inline constexpr float kPointError = 0x1p-16f;

/// The weights of the vertices where `ray` hits; they sum to 1, none is negative.
[[nodiscard]] glm::dvec3 barycentric(const Corners& corners, const Ray& ray);

/// The normals of the file at the hit, or the triangle's own; of no particular length or side. A
/// triangle that is hit has an area, so its own normal is never 0.
[[nodiscard]] glm::dvec3 file_normal(const Scene& scene, const Triangle& triangle,
                                     const Corners& corners, const glm::dvec3& weights);

/// What shading needs to know of a hit. In double: decided exactly is only what was hit.
struct Surface {
  std::uint32_t slot = 0, triangle = 0;
  const Material* material = nullptr;
  glm::dvec3 diffuse{0.0};      ///< the material's diffuse colour here
  glm::dvec3 point{0.0};        ///< in the scene's coordinates
  glm::dvec3 view{0.0};         ///< unit vector back along the ray
  glm::dvec3 flat_normal{0.0};  ///< unit normal of the triangle, to the side of the ray
  /// Unit normal, interpolated where the file has normals, to the same side; where that would not
  /// be seen from the ray, tilted until it is at right angles to the ray.
  glm::dvec3 normal{0.0};
  /// The ray comes from outside: from where the file's normals point or, without, from where the
  /// vertices run counter-clockwise.
  bool outside = true;

  /// `unit_point`: P as the hit-test unit has it, which the surface's point is made of; nullptr: it
  /// is found from the corners, in double.
  Surface(const Scene& scene, const Bvh& bvh, const Ray& ray, std::uint32_t slot,
          const glm::vec3* unit_point);
};

}  // namespace raygate
