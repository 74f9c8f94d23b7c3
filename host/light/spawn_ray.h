// Spawning rays: the origin of a ray that leaves a surface, reflected, refracted or towards a
// light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/base/vectors.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/light/neighbor_clearance.h"

namespace raygate {

/// The side of the surface on which a spawned ray begins.
enum class SpawnSide {
  kIncident,     ///< the side the ray came from: reflection, shadow rays
  kTransmitted,  ///< the other side: refraction
};

/// A ray, its direction scaled, that hit the triangle `primitive` and spawns another ray.
struct SpawnQuery {
  const Ray* ray = nullptr;
  std::uint32_t primitive = 0;
  SpawnSide side = SpawnSide::kIncident;
};

/// The origin of the spawned ray, if there is one.
struct SpawnOrigin {
  glm::vec3 point{0.0f};
  std::uint32_t exists = 0;  ///< or anything else

  explicit operator bool() const { return exists != 0; }
  const glm::vec3& operator*() const { return point; }
};

/// Finds origins for secondary rays without an epsilon.
///
/// Let X be the point, exact and hardly ever a float, in which a ray first hits a triangle. The
/// origin O' is a float point near X that lies strictly on the same side of the triangle's plane,
/// and of the plane of every other triangle that comes near on that side, as the points of the ray
/// just before X (for kIncident) or just after it (for kTransmitted), decided in exact arithmetic.
/// So
///   * no triangle lies between the ray at X and O': none is skipped, in the sharpest corner;
///   * a ray from O' that goes away from the triangle's plane (leaves() says so exactly) never
///     hits that triangle again.
///
/// X is what exact arithmetic makes of the corners, in double, not the unit's P: an origin that
/// stood off by what P may be off would be no nearer to what is seen, and farther from the surface.
///
/// How far: let u be one float step (ulp) of X's largest coordinate, or the error of X in double
/// if that is more. Where no other triangle is within 4 u of X, O' is within 1.5 u, or 3 u next to
/// a power of two, of X as double has it, on each axis: spawn_ray.cpp has the proof. From the exact
/// X it is farther by that error, which only far from the origin shows (1.528 u). In corners too
/// narrow for that O' backs away from X, by powers of two, along the normal or the ray, or to the
/// ray's origin itself, so that in a convex room there always is an O' for kIncident. In other
/// corners, narrower than floats can express, there may be none: the ray had better end there.
class RaySpawner {
 public:
  /// The clearances must outlive this.
  explicit RaySpawner(const NeighborClearances& clearances)
      : clearances_(clearances), bvh_(clearances.bvh()) {}

  /// O' for `ray`, whose nearest hit is the triangle in `primitive`. The triangles in whose plane
  /// the ray runs have no say.
  [[nodiscard]] std::optional<glm::vec3> find(const Ray& ray, std::uint32_t primitive,
                                              SpawnSide side);

  /// Says that a primitive will soon be asked about.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const { clearances_.prefetch(primitive); }

  /// origins[i] becomes O' for queries[i]: what find() gives, several at a time and so much
  /// sooner.
  void find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins);

  /// Whether `direction` goes away from the triangle that `ray` hit, to the side where O' is.
  /// Shading normals and rounding may give directions that do not.
  [[nodiscard]] bool leaves(const Ray& ray, std::uint32_t primitive, SpawnSide side,
                            const glm::vec3& direction) const;

 private:
  template <Vectors kCode, class T>
  RAYGATE_INLINE void find_some(const SpawnQuery* queries, SpawnOrigin* origins);

  /// Of a query in this lane.
  [[nodiscard]] RAYGATE_INLINE const NeighborClearance& clearance_of(std::uint32_t primitive,
                                                                     int lane) {
    if (bvh_.is_instanced(primitive)) [[unlikely]]
      return find_clearance(primitive, static_cast<std::size_t>(lane));
    return clearances_.of(primitive);
  }
  [[nodiscard]] const NeighborClearance& find_clearance(std::uint32_t primitive, std::size_t lane);

  /// As find(), looking at what is near.
  [[nodiscard]] std::optional<glm::vec3> search(const Ray& ray, std::uint32_t primitive,
                                                SpawnSide side);

  const NeighborClearances& clearances_;
  const Bvh& bvh_;
  std::vector<NeighborClearances::Found> found_;  // of instances' triangles, by lane
};

}  // namespace raygate
