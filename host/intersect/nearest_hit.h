// The nearest hit of a ray, and the order of hits: exact, whatever found them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/intersect/intersect_counters.h"

namespace raygate {

/// A hit of a ray; without one, `primitive` alone has a meaning.
struct NearestHit {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t primitive = kNone;  ///< of the tree; kNone: nothing hit
  glm::vec3 point{0.0f};  ///< P = d I / (I . N) in the unit's bits, seen from the ray's origin
  /// Each coordinate of P is off by at most so much of itself; +infinity where the unit has no P to
  /// speak of. The same bits whatever found the hit.
  float point_error = std::numeric_limits<float>::infinity();
  Interval t{};  ///< holds the exact t
};

/// Whether P may be off by more than `most` (finite) of itself: then it is for the host to compute.
[[nodiscard]] inline bool is_point_doubt(const NearestHit& hit, float most) {
  return !(hit.point_error <= most);
}

/// Whether the hit has t < limit (positive), exactly.
[[nodiscard]] bool is_before(const Bvh& bvh, const Ray& ray, const NearestHit& hit, float limit);

/// Whether hit `a` is nearer than hit `b`, exactly; of equally far ones the one of the lower
/// triangle is.
[[nodiscard]] bool is_nearer(const Bvh& bvh, const Ray& ray, const NearestHit& a,
                             const NearestHit& b);

/// Makes `hit` the ray's `best` one if it has t < limit and is nearer. True if so. Of the outcome
/// of several offers, their order does not matter. Counts what took exact arithmetic.
bool take_if_nearer(const Bvh& bvh, const Ray& ray, float limit, const NearestHit& hit,
                    NearestHit& best, IntersectCounters& counters);

/// The same for a triangle of which float32 says neither that it is hit nor that it is missed:
/// its `t` need not be known. Asks for the distance first, as that takes doubles alone as a rule.
bool resolve_doubt(const Bvh& bvh, const Ray& ray, float limit, NearestHit doubt, NearestHit& best,
                   IntersectCounters& counters);

}  // namespace raygate
