// Origins of rays that leave a surface: reflected, refracted, or towards a light. Most origins
// follow from the clearance of a triangle: its distance from other triangles.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"

namespace raygate {

/// A triangle that intersects or (nearly) touches the interior of another one, with its bounds.
struct Overlap {
  std::uint32_t primitive;
  glm::vec3 low, high;

  /// Returns whether the bounds touch the closed box from `from` to `to`.
  [[nodiscard]] bool touches(const glm::vec3& from, const glm::vec3& to) const {
    return glm::all(glm::lessThanEqual(low, to)) && glm::all(glm::lessThanEqual(from, high));
  }
};
using Overlaps = std::vector<Overlap>;

/// The clearance of a triangle ABC for rays that start on it: one cache line.
///
/// Let w be the smallest barycentric coordinate of a point of ABC. Every other triangle is at least
/// c w - margin() away from the point, unless it is farther than spawn_reach(), one of the
/// overlaps, or in the plane of ABC. If ABC touches others only at edges and vertices, it has no
/// overlaps, and c is a fraction of its smallest height.
struct alignas(64) NeighborClearance {
  double normal[3] = {};  ///< (B-A) x (C-A) times a power of two; errors add up to less than 1
  /// c, at most 1/8 of the smallest height; -c if there are overlaps; 0 if unknown.
  float length = 0.0f;
  float corner[3] = {};       ///< A
  float gradient[2][3] = {};  ///< in-plane gradients of c times the weights of B and C
};

/// Returns the distance beyond which other triangles are irrelevant to rays that start on a
/// triangle with these vertices: at least 16 float steps of its largest coordinate.
[[nodiscard]] double spawn_reach(const Corners& corners);

/// Returns whether no point of `other` is strictly on the given side (as in orient3d) of the plane
/// of `hit`. If so, lines from the plane to this side miss `other`.
[[nodiscard]] bool lies_beyond(const Corners& other, const Corners& hit, int side);

/// The clearances and overlaps of all triangles of a BVH, computed on first use and stored, except
/// for instances' triangles. Thread-safe.
class NeighborClearances {
 public:
  /// `bvh` must outlive this object.
  explicit NeighborClearances(const Bvh& bvh);

  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] float margin() const { return margin_; }

  /// A clearance that is not stored.
  struct Found {
    NeighborClearance clearance;
    Overlaps overlaps;
  };
  /// Computes the clearance of any primitive, including those of instances.
  [[nodiscard]] Found compute(std::uint32_t primitive) const;

  /// Returns the clearance of a primitive that belongs to no instance.
  [[nodiscard]] RAYGATE_INLINE const NeighborClearance& of(std::uint32_t primitive) const {
    const NeighborClearance* const clearance =
        known_[primitive].clearance.load(std::memory_order_acquire);
    return clearance != nullptr ? *clearance : find(primitive);
  }
  /// Prefetch the clearance of a primitive for of(): prefetch() early, prefetch_again() later.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const {
    if (!bvh_.is_instanced(primitive)) __builtin_prefetch(&known_[primitive]);
  }
  RAYGATE_INLINE void prefetch_again(std::uint32_t primitive) const {
    if (bvh_.is_instanced(primitive)) return;
    __builtin_prefetch(known_[primitive].clearance.load(std::memory_order_relaxed));
  }
  /// Returns the overlaps of a primitive whose clearance is known and negative.
  [[nodiscard]] const Overlaps& overlaps_of(std::uint32_t primitive) const {
    return *known_[primitive].overlaps.load(std::memory_order_relaxed);
  }

 private:
  /// The cached data of a primitive.
  struct Known {
    std::atomic<const NeighborClearance*> clearance{nullptr};  // null: not computed yet
    std::atomic<const Overlaps*> overlaps{nullptr};
  };

  /// Computes and stores the clearance.
  [[nodiscard]] const NeighborClearance& find(std::uint32_t primitive) const;

  const Bvh& bvh_;
  float margin_;
  double slack_;  // error bound of a computed coordinate along a unit vector
  std::unique_ptr<Known[]> known_;
  mutable std::mutex mutex_;
  mutable std::deque<NeighborClearance> clearances_;
  mutable std::deque<Overlaps> overlaps_;
};

/// Side of the surface on which a spawned ray begins.
enum class SpawnSide {
  kIncident,     ///< the side the ray came from: reflection, shadow rays
  kTransmitted,  ///< the other side: refraction
};

/// A ray, with a direction from scaled_direction(), that hit triangle `primitive` and spawns a ray.
struct SpawnQuery {
  const Ray* ray = nullptr;
  std::uint32_t primitive = 0;
  SpawnSide side = SpawnSide::kIncident;
};

/// The origin of the spawned ray, if there is one.
struct SpawnOrigin {
  glm::vec3 point{0.0f};
  std::uint32_t exists = 0;  ///< non-zero if there is an origin

  explicit operator bool() const { return exists != 0; }
  const glm::vec3& operator*() const { return point; }
};

/// Finds origins for secondary rays without an epsilon.
///
/// Let X be the exact point, rarely a float, at which a ray first hits a triangle. The origin O' is
/// a float point near X. O' lies strictly on the side of the ray's points just before X (kIncident)
/// or just after X (kTransmitted). This holds for the triangle's plane and for the plane of every
/// other triangle near O' on this side. Exact arithmetic decides the sides. So
///   * no triangle lies between X and O', so none is skipped, even in the sharpest corner;
///   * a ray from O' that leaves the triangle's plane (see leaves()) never hits the triangle again.
///
/// Distance: X is computed in double from the corners. Let u be the larger of X's error and one
/// float step (ulp) of X's largest coordinate. If no other triangle is within 4 u of X, O' is
/// within 1.5 u (3 u next to a power of two) of the computed X on each axis (proof in
/// spawn_ray.cpp). In narrower corners, candidates for O' are farther away, by powers of two times
/// u, along the normal or the ray. The last one is the ray's origin, so a convex room always has an
/// O' for kIncident. Corners narrower than the precision of float may have no O'; paths end there.
class RaySpawner {
 public:
  /// `clearances` must outlive this object.
  explicit RaySpawner(const NeighborClearances& clearances)
      : clearances_(clearances), bvh_(clearances.bvh()) {}

  /// Returns O' for `ray`, whose nearest hit is the triangle `primitive`, or none. Triangles whose
  /// plane contains the ray are ignored.
  [[nodiscard]] SpawnOrigin find(const Ray& ray, std::uint32_t primitive, SpawnSide side);

  /// Prefetches the clearance of a primitive of a later query.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const { clearances_.prefetch(primitive); }

  /// Sets origins[i] to O' for queries[i], as find() above does, but four at a time.
  void find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins);

  /// Returns whether `direction` leaves the triangle that `ray` hit on the side of O'. Directions
  /// made with shading normals, or rounded, may not.
  [[nodiscard]] bool leaves(const Ray& ray, std::uint32_t primitive, SpawnSide side,
                            const glm::vec3& direction) const;

 private:
  template <Vectors kCode>
  RAYGATE_INLINE void find_four(const SpawnQuery* queries, SpawnOrigin* origins);

  /// Returns O' for a ray by a search of nearby triangles.
  [[nodiscard]] SpawnOrigin search(const Ray& ray, std::uint32_t primitive, SpawnSide side);

  const NeighborClearances& clearances_;
  const Bvh& bvh_;
  NeighborClearances::Found found_[kQuad];  // of instances' triangles, by lane
};

}  // namespace raygate
