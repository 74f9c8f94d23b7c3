// Intersector: the interface of engines that find the nearest hits of rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>

#include "host/base/measure.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/intersect/intersect_counters.h"

namespace raygate {

/// The nearest hit of a ray; without one, only `primitive` is valid.
struct NearestHit {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t primitive = kNone;  ///< primitive index; kNone: a miss
  glm::vec3 point{0.0f};  ///< P = d I / (I . N), relative to the ray's origin, in the unit's bits
  /// Relative error bound of each coordinate of P, in addition to 2^-46 of the largest coordinate
  /// for underflow; +infinity if the unit has no usable P. Every intersector gives the same bits.
  float point_error = std::numeric_limits<float>::infinity();
  Interval t{};  ///< contains the exact t
};

/// Returns whether the relative error of P may exceed `most` (finite), so that the host computes P.
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

/// Options of a search for many rays. Spans must outlive it, and are empty or have one element per
/// ray. Those from `skip_ids` on are for Intersector::occluded.
struct RayQuery {
  /// All rays start at one point (the camera, a light), which some engines make use of. Does not
  /// change results.
  bool common_origin = false;
  /// Positive. Only hits with exact t < t_max[i] count; +infinity: no limit.
  std::span<const float> t_max{};
  /// The rays in binary64, of which `rays` are the nearest ones in binary32; empty: `rays` are
  /// exact. Only CpuIntersector accepts them, and not of a common origin. NearestHit::point is that
  /// of the rounded ray.
  std::span<const ExactRay> exact_rays{};
  /// The primitive that the ray leaves and surely does not hit, or NearestHit::kNone. Does not
  /// change results, but saves the test that is hardest to decide.
  std::span<const std::uint32_t> source_ids{};
  /// Receives the work of each ray.
  std::span<RayWork> work{};
  /// A primitive whose hits are ignored, or NearestHit::kNone.
  std::span<const std::uint32_t> skip_ids{};
  /// A ray ends at the first hit found with t < any_hit_before[i], and reports it as its nearest.
  std::span<const float> any_hit_before{};
  /// nearest() computes NearestHit::point.
  bool with_points = true;

  /// Returns t_max[i], or +infinity if t_max is empty.
  [[nodiscard]] float t_max_of(std::size_t i) const {
    return t_max.empty() ? std::numeric_limits<float>::infinity() : t_max[i];
  }
};

/// What an engine makes use of.
struct EngineTraits {
  /// Best number of rays per query: about 16,384 for each test done at the same time.
  std::size_t batch = std::size_t{1} << 14;
  bool takes_exact_rays = false;  ///< RayQuery::exact_rays
  bool wants_sources = false;     ///< benefits from RayQuery::source_ids that need exact arithmetic
};

/// Finds nearest hits with exact decisions: results depend only on ray and scene, not on the
/// intersector or the other rays of the query. Not thread-safe: each thread has its own.
class Intersector {
 public:
  explicit Intersector(const EngineTraits& traits) : traits_(traits) {}
  virtual ~Intersector() = default;

  [[nodiscard]] const EngineTraits& traits() const { return traits_; }

  /// Sets hits[i] to the nearest hit of rays[i]. Neighbouring rays should have similar directions.
  /// Directions that are zero or not finite hit nothing; others must be scaled (is_scaled), or
  /// std::invalid_argument is thrown.
  void nearest(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits);

  /// Sets hits[i] to a hit of rays[i] with t < any_hit_before[i] if there is one, otherwise to the
  /// nearest hit. Points are not computed. Directions are as in nearest().
  void occluded(std::span<const Ray> rays, RayQuery query, std::span<NearestHit> hits);

  [[nodiscard]] virtual IntersectCounters counters() const = 0;

 protected:
  friend class CheckIntersector;

  /// Does the work of nearest() and occluded(); `hits` are initialised to misses, and `work` to 0.
  virtual void trace(std::span<const Ray> rays, const RayQuery& query,
                     std::span<NearestHit> hits) = 0;

  EngineTraits traits_;
};

/// Throws the exception of Intersector::nearest for a direction that is not scaled.
[[noreturn]] void throw_unscaled(const Ray& ray);

/// Makes the intersector of a thread; called on that thread. The factory owns shared data.
using IntersectorFactory = std::function<std::unique_ptr<Intersector>()>;

/// Returns whether a hit has t < t_max (positive); exact.
[[nodiscard]] bool is_before(const Bvh& bvh, const ExactRay& ray, const NearestHit& hit,
                             float t_max);

/// Returns whether hit `a` is nearer than `b`, exactly; for equal t, by the lower triangle index.
[[nodiscard]] bool is_nearer(const Bvh& bvh, const ExactRay& ray, const NearestHit& a,
                             const NearestHit& b);

/// Replaces `best` by `hit` if that is a hit with t < t_max and nearer; returns whether it did. The
/// order of calls does not matter. If not `is_sure`, binary32 finds the triangle neither hit nor
/// missed, and hit.t is not read; the distance is decided first, which usually needs doubles only.
/// Counts the use of exact arithmetic.
bool take_if_nearest(const Bvh& bvh, const ExactRay& ray, float t_max, NearestHit hit, bool is_sure,
                     NearestHit& best, IntersectCounters& counters);

}  // namespace raygate
