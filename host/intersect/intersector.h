// Intersector: the interface of everything that finds the nearest hits of rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>

#include "host/base/counts.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/intersect/intersect_counters.h"

namespace raygate {

/// The nearest hit of a ray; without one, only `primitive` is valid.
struct NearestHit {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t primitive = kNone;  ///< index of the tree's primitive; kNone: nothing is hit
  glm::vec3 point{0.0f};  ///< P = d I / (I . N), relative to the ray's origin, in the unit's bits
  /// Error bound of P's coordinates, of each of itself, besides 2^-46 of the largest, for what
  /// underflows; +infinity where the unit gives no usable P. The same
  /// bits from every intersector.
  float point_error = std::numeric_limits<float>::infinity();
  Interval t{};  ///< holds the exact t
};

/// Whether P may be off by more than `most` (finite) of itself: the host then computes it.
[[nodiscard]] inline bool is_point_doubt(const NearestHit& hit, float most) {
  return !(hit.point_error <= most);
}

/// Work done for one ray.
struct RayWork {
  std::uint32_t tests = 0, doubts = 0;

  RayWork& operator+=(const RayWork& other) {
    add_count(tests, other.tests);
    add_count(doubts, other.doubts);
    return *this;
  }
};

/// Options of a query for many rays. Spans have one element a ray, or are empty; they must live as
/// long as the query.
struct RayQuery {
  /// All rays begin in one point that other queries use too (the camera, a light): what is made for
  /// it is kept. Changes no result.
  bool common_origin = false;
  /// Positive: only hits with t < t_max[i], in exact arithmetic, count; +infinity: all.
  std::span<const float> t_max{};
  /// A primitive whose hits do not count, or NearestHit::kNone. With skip_ids or any_hit_before,
  /// NearestHit::point is not valid.
  std::span<const std::uint32_t> skip_ids{};
  /// A primitive that the ray does not hit, as its sender knows: its source, the one that it
  /// leaves; or NearestHit::kNone. Changes no result, but saves the test that is hardest to decide.
  std::span<const std::uint32_t> source_ids{};
  /// A ray ends at the first hit found with t < any_hit_before[i], and reports it as its nearest.
  std::span<const float> any_hit_before{};
  /// With any_hit_before, if filters_hits() and no common origin: which sure hits are enough, by
  /// ray and primitive; without any the nearest is reported. nullptr: all are.
  const std::function<bool(std::size_t ray, std::uint32_t primitive)>* is_enough = nullptr;
  /// False: every ray is tested against every polygon, whatever the boxes say.
  bool culling = true;
  /// Receives the work done for each ray.
  std::span<RayWork> work{};

  /// Of ray i; +infinity where t_max is empty.
  [[nodiscard]] float t_max_of(std::size_t i) const {
    return t_max.empty() ? std::numeric_limits<float>::infinity() : t_max[i];
  }
  /// Whether NearestHit::point is to be computed.
  [[nodiscard]] bool with_points() const { return skip_ids.empty() && any_hit_before.empty(); }
};

/// Finds nearest hits, decided exactly: they depend on rays and scene alone, not on the
/// intersector, nor on the other rays of the query. One thread each.
class Intersector {
 public:
  virtual ~Intersector() = default;

  /// hits[i] becomes the nearest hit of rays[i]. Rays near each other in `rays` should go about the
  /// same way. Directions that are zero or not finite hit nothing; all others must be scaled
  /// (is_scaled): throws std::invalid_argument at the first that is not.
  virtual void intersect(std::span<const Ray> rays, const RayQuery& query,
                         std::span<NearestHit> hits) = 0;

  /// The best number of rays for one query; about 16,384 for each test that runs at the same time.
  [[nodiscard]] virtual std::size_t preferred_batch() const { return kBatch; }

  /// Whether RayQuery::source_ids are worth an exact decision of who sends a ray.
  [[nodiscard]] virtual bool wants_sources() const { return false; }

  /// Whether RayQuery::is_enough is asked.
  [[nodiscard]] virtual bool filters_hits() const { return false; }

  [[nodiscard]] virtual IntersectCounters counters() const = 0;

 protected:
  static constexpr std::size_t kBatch = std::size_t{1} << 14;
  /// What every query begins with: no hits, no work.
  static void clear(const RayQuery& query, std::span<NearestHit> hits);
};

/// Throws what Intersector::intersect promises for a direction that is not scaled.
[[noreturn]] void throw_unscaled(const Ray& ray);

/// Makes the intersector of one thread; called on that thread. The factory owns what they share.
using IntersectorFactory = std::function<std::unique_ptr<Intersector>()>;

/// Whether the hit has t < t_max (positive), exactly.
[[nodiscard]] bool is_before(const Bvh& bvh, const Ray& ray, const NearestHit& hit, float t_max);

/// Whether hit `a` is nearer than hit `b`, exactly; ties in t: lower triangle index first.
[[nodiscard]] bool is_nearer(const Bvh& bvh, const Ray& ray, const NearestHit& a,
                             const NearestHit& b);

/// Makes `hit` the ray's `best` one if it has t < t_max and is nearer; true if so. The order of
/// several offers does not matter. Counts the use of exact arithmetic.
bool take_if_nearer(const Bvh& bvh, const Ray& ray, float t_max, const NearestHit& hit,
                    NearestHit& best, IntersectCounters& counters);

/// The same for a triangle that float32 calls neither hit nor missed; `doubt.t` is not read. Asks
/// for the distance first, which takes doubles alone as a rule.
bool resolve_doubt(const Bvh& bvh, const Ray& ray, float t_max, NearestHit doubt, NearestHit& best,
                   IntersectCounters& counters);

}  // namespace raygate
