// Intersector: the interface of engines that find the nearest hits of rays, and their counters.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>

#include "host/base/measure.h"
#include "host/bvh/bvh.h"

namespace raygate {

/// Adds `other` to `sum`, field by field. All fields of Counters are std::uint64_t.
template <class Counters>
void add_counters(Counters& sum, const Counters& other) {
  using Words = std::array<std::uint64_t, sizeof(Counters) / sizeof(std::uint64_t)>;
  auto words = std::bit_cast<Words>(sum);
  const auto others = std::bit_cast<Words>(other);
  for (std::size_t i = 0; i < words.size(); ++i) words[i] += others[i];
  sum = std::bit_cast<Counters>(words);
}

/// Tests of rays against polygons, and the work of a hit-test unit.
struct HitCounters {
  std::uint64_t tests = 0;         ///< (ray, polygon) pairs: misses + hits + edge_doubts
  std::uint64_t misses = 0;        ///< sure misses
  std::uint64_t hits = 0;          ///< sure hits
  std::uint64_t edge_doubts = 0;   ///< neither sure misses nor sure hits
  std::uint64_t depth_doubts = 0;  ///< sure hits that binary32 cannot order
  std::uint64_t plane_tests = 0;   ///< hit points computed
  // The fields below are 0 without a unit.
  std::uint64_t unit_tests = 0;     ///< tests done by the unit
  std::uint64_t clocks = 0;         ///< simulated clock cycles
  std::uint64_t idle_clocks = 0;    ///< clocks without a test, summed over the pipeline's lanes
  std::uint64_t output_stalls = 0;  ///< clocks stalled by the consumer, summed over the lanes
  std::uint64_t exact_clocks = 0;   ///< busy clocks of the exact units of ray cores

  HitCounters& operator+=(const HitCounters& other) {
    add_counters(*this, other);
    return *this;
  }
};

/// Statistics of an intersector since its construction.
struct IntersectCounters {
  HitCounters hit;
  std::uint64_t exact_inside = 0;  ///< edge doubts that exact arithmetic resolved
  std::uint64_t exact_depth = 0;   ///< exact comparisons of two hits, or of a hit and t_max
  std::uint64_t ended_early = 0;   ///< rays ended early by RayQuery::any_hit_before
  std::uint64_t records = 0;       ///< polygon records made
  double seconds = 0.0;            ///< spent in nearest()

  IntersectCounters& operator+=(const IntersectCounters& other) {
    hit += other.hit;
    exact_inside += other.exact_inside;
    exact_depth += other.exact_depth;
    ended_early += other.ended_early;
    records += other.records;
    seconds += other.seconds;
    return *this;
  }
};

/// The nearest hit of a ray. If the ray hits nothing, only `primitive` is valid.
struct NearestHit {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t primitive = kNone;  ///< primitive index; kNone: a miss
  glm::vec3 point{0.0f};  ///< hit point minus the ray's origin; the same bits as in hardware
  /// Relative error bound of each coordinate of `point`, in addition to 2^-46 of the largest
  /// coordinate for underflow; +infinity if `point` is not usable. The same bits in every engine.
  float point_error = std::numeric_limits<float>::infinity();
  Interval t{};  ///< contains the exact t
};

/// Work done for one ray.
struct RayWork {
  std::uint32_t tests = 0, doubts = 0;

  RayWork& operator+=(const RayWork& other) {
    add_count(tests, other.tests);
    add_count(doubts, other.doubts);
    return *this;
  }
};

/// Options of a search. Spans must outlive the search. A span is empty or has one element per ray.
struct RayQuery {
  /// Whether all rays start at one point. Makes some engines faster; does not change results.
  bool common_origin = false;
  /// Positive. Only hits with exact t < t_max[i] count; +infinity: no limit.
  std::span<const float> t_max{};
  /// The exact rays, if `rays` are rounded from binary64; empty if `rays` are exact. Only
  /// CpuIntersector accepts exact rays, and ignores `common_origin` if there are any.
  /// NearestHit::point is computed from the rounded ray.
  std::span<const ExactRay> exact_rays{};
  /// The primitive on which the ray starts, if the caller knows that the ray does not hit it; else
  /// NearestHit::kNone. Does not change results; saves the test that is hardest to decide.
  std::span<const std::uint32_t> source_ids{};
  /// Receives the work of each ray.
  std::span<RayWork> work{};
  /// A primitive whose hits are ignored, or NearestHit::kNone.
  std::span<const std::uint32_t> skip_ids{};
  /// A ray ends at the first hit found with t < any_hit_before[i], which becomes its nearest hit.
  std::span<const float> any_hit_before{};
  bool with_points = true;  ///< whether to compute NearestHit::point

  /// Returns t_max[i], or +infinity if t_max is empty.
  [[nodiscard]] float t_max_of(std::size_t i) const {
    return t_max.empty() ? std::numeric_limits<float>::infinity() : t_max[i];
  }
};

/// Properties of an engine, for callers that prepare its queries.
struct EngineTraits {
  /// Best number of rays per query: about 16,384 for each test that the engine does in parallel.
  std::size_t batch = std::size_t{1} << 14;
  bool takes_exact_rays = false;  ///< RayQuery::exact_rays
  bool wants_sources = false;     ///< source_ids save more time than it takes to find them
};

/// Finds nearest hits with exact decisions: results depend only on ray and scene, not on the
/// intersector or the other rays of the query. Not thread-safe.
class Intersector {
 public:
  explicit Intersector(const EngineTraits& traits) : traits_(traits) {}
  virtual ~Intersector() = default;

  [[nodiscard]] const EngineTraits& traits() const { return traits_; }

  /// Sets hits[i] to the nearest hit of rays[i]. Neighbouring rays should have similar directions.
  /// Directions that are zero or not finite hit nothing; others must be scaled (is_scaled), or
  /// std::invalid_argument is thrown.
  void nearest(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits);

  [[nodiscard]] virtual IntersectCounters counters() const = 0;

 protected:
  /// Does the work of nearest(); `hits` are initialised to misses, and `work` to 0.
  virtual void trace(std::span<const Ray> rays, const RayQuery& query,
                     std::span<NearestHit> hits) = 0;

  EngineTraits traits_;
};

/// Throws the exception of Intersector::nearest for a direction that is not scaled.
[[noreturn]] void throw_unscaled(const Ray& ray);

/// Makes the intersector of a thread; called on that thread. The factory owns shared data.
using IntersectorFactory = std::function<std::unique_ptr<Intersector>()>;

/// Returns, exactly, whether a hit has t < t_max >= 2^-149; above the largest float: no limit.
[[nodiscard]] bool is_before(const Bvh& bvh, const ExactRay& ray, const NearestHit& hit,
                             double t_max);

/// Returns, exactly, whether `a` is nearer than `b` or, at equal t, has the lower triangle index.
[[nodiscard]] bool is_nearer(const Bvh& bvh, const ExactRay& ray, const NearestHit& a,
                             const NearestHit& b);

/// Replaces `best` by `hit` if `hit` is nearer and has t < t_max. Returns whether `best` changed.
/// The order of calls does not matter. If not `is_sure`, exact arithmetic decides whether `hit` is
/// a hit at all, and hit.t is not read. Counts the use of exact arithmetic in `counters`.
bool take_if_nearest(const Bvh& bvh, const ExactRay& ray, float t_max, NearestHit hit, bool is_sure,
                     NearestHit& best, IntersectCounters& counters);

}  // namespace raygate
