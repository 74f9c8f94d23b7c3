// Origins of rays that leave a surface: reflected, refracted, or towards a light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "host/base/vectors.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/light/neighbor_clearance.h"

namespace raygate {

/// Side of the surface on which a spawned ray begins.
enum class SpawnSide {
  kIncident,     ///< the side the ray came from: reflection, shadow rays
  kTransmitted,  ///< the other side: refraction
};

/// A ray with a scaled direction that hit the triangle `primitive` and spawns another ray.
struct SpawnQuery {
  const Ray* ray = nullptr;
  std::uint32_t primitive = 0;
  SpawnSide side = SpawnSide::kIncident;
};

/// The origin of the spawned ray, if there is one.
struct SpawnOrigin {
  glm::vec3 point{0.0f};
  std::uint32_t exists =
      0;  ///< non-zero if there is an origin (an integer, so that lanes store it)

  explicit operator bool() const { return exists != 0; }
  const glm::vec3& operator*() const { return point; }
};

/// Finds origins for secondary rays without an epsilon.
///
/// Let X be the exact point, hardly ever a float, in which a ray first hits a triangle. The origin
/// O' is a float point near X. It lies strictly on the same side of the triangle's plane, and of
/// the plane of every other triangle that is near on that side, as the points of the ray just
/// before X (kIncident) or just after it (kTransmitted), decided in exact arithmetic. So
///   * no triangle lies between X and O': none is skipped, even in the sharpest corner;
///   * a ray from O' that leaves the triangle's plane (decided exactly by leaves()) never hits that
///     triangle again.
///
/// X is computed in double from the corners, not from the unit's P, whose error would move O'
/// farther from the surface.
///
/// Distance: let u be one float step (ulp) of X's largest coordinate, or the error of X in double
/// if that is larger. If no other triangle is within 4 u of X, O' is within 1.5 u (3 u next to a
/// power of two) of X in double on each axis (proof in spawn_ray.cpp); the distance from the exact
/// X is larger by the error of X (1.528 u far from the origin). In narrower corners O' moves away
/// from X by powers of two, along the normal or the ray, up to the ray's origin, so that a convex
/// room always has an O' for kIncident. Corners narrower than the precision of float may have none;
/// the path ends there.
class RaySpawner {
 public:
  /// `clearances` must outlive this object.
  explicit RaySpawner(const NeighborClearances& clearances)
      : clearances_(clearances), bvh_(clearances.bvh()) {}

  /// Returns O' for `ray`, whose nearest hit is the triangle `primitive`, or none. Triangles whose
  /// plane contains the ray are ignored.
  [[nodiscard]] std::optional<glm::vec3> find(const Ray& ray, std::uint32_t primitive,
                                              SpawnSide side);

  /// Prefetches the clearance of a primitive of a later query.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const { clearances_.prefetch(primitive); }

  /// Sets origins[i] to O' for queries[i], as find() above does, but four at a time.
  void find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins);

  /// Returns whether `direction` leaves the triangle that `ray` hit on the side of O'. Directions
  /// made with shading normals, or rounded, may not.
  [[nodiscard]] bool leaves(const Ray& ray, std::uint32_t primitive, SpawnSide side,
                            const glm::vec3& direction) const;

  /// Returns how often find() has compared a triangle with a candidate for O', apart from the fast
  /// path.
  [[nodiscard]] std::uint64_t triangle_tests() const { return triangle_tests_; }

 private:
  template <Vectors kCode>
  RAYGATE_INLINE void find_four(const SpawnQuery* queries, SpawnOrigin* origins);

  /// Does the work of find() by a search of nearby triangles.
  [[nodiscard]] std::optional<glm::vec3> search(const Ray& ray, std::uint32_t primitive,
                                                SpawnSide side);

  const NeighborClearances& clearances_;
  const Bvh& bvh_;
  NeighborClearances::Found found_[kQuad];  // of instances' triangles, by lane
  std::uint64_t triangle_tests_ = 0;
};

}  // namespace raygate
