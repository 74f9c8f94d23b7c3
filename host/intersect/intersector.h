// Rays in, nearest hits out: the one way for a ray, whoever does the tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/intersect/intersect_counters.h"
#include "host/intersect/nearest_hit.h"

namespace raygate {

/// What the query for one ray's hit took.
struct RayWork {
  std::uint32_t tests = 0, doubts = 0;

  RayWork& operator+=(const RayWork& other) {
    tests += other.tests;
    doubts += other.doubts;
    return *this;
  }
};

/// What is wanted of a query, given once. Spans have one element a ray, or are empty; they are
/// used during the query only.
struct RayQuery {
  /// All rays begin in one point, from which other searches begin, too (the camera, a light): what
  /// is made for it is worth keeping. Changes nothing of what is found.
  bool common_origin = false;
  /// Positive: only hits with t < t_max[i], in exact arithmetic, count; +infinity for no limit.
  std::span<const float> t_max{};
  /// A primitive whose hits do not count, or NearestHit::kNone. With it, or with `any_hit_before`,
  /// NearestHit::point says nothing.
  std::span<const std::uint32_t> skip_ids{};
  /// For rays that need not know their nearest hit: a ray ends at the first hit that is found with
  /// t < any_hit_before[i]; that one is reported as the nearest.
  std::span<const float> any_hit_before{};
  /// False: every ray is tested against every polygon, whatever the boxes say.
  bool culling = true;
  /// Where to write what each ray's query took.
  std::span<RayWork> work{};

  /// Of ray i; +infinity where t_max is empty.
  [[nodiscard]] float t_max_of(std::size_t i) const {
    return t_max.empty() ? std::numeric_limits<float>::infinity() : t_max[i];
  }
};

/// Finds nearest hits, decided exactly: they depend on rays and scene alone, not on the
/// intersector, nor on the other rays of the query. Not for use by two threads at once: each makes
/// its own.
class Intersector {
 public:
  virtual ~Intersector() = default;

  /// hits[i] becomes the nearest hit of rays[i]. Rays near each other in `rays` should go about the
  /// same way. Directions that are zero or not finite hit nothing; all others must be scaled
  /// (is_scaled): throws std::invalid_argument at the first that is not.
  virtual void intersect(std::span<const Ray> rays, const RayQuery& query,
                         std::span<NearestHit> hits) = 0;

  /// So many rays at once are best; about 16,384 for each test that goes on at the same time.
  [[nodiscard]] virtual std::size_t preferred_batch() const { return kBatch; }

  [[nodiscard]] virtual IntersectCounters counters() const = 0;

 protected:
  static constexpr std::size_t kBatch = std::size_t{1} << 14;
};

/// Throws what Intersector::find promises where a direction is not scaled.
[[noreturn]] void throw_unscaled(const Ray& ray);

/// Makes the intersector of one thread; called on that thread. What intersectors share is the
/// factory's.
using IntersectorFactory = std::function<std::unique_ptr<Intersector>()>;

}  // namespace raygate
