// Rays of any origins, tested in place, one by one: no records, no batches.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/find/nearest_hits.h"
#include "host/find/search_wishes.h"
#include "host/find/unit/hit_tester.h"
#include "host/find/unit/record_batch.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Finds what a Wavefront finds through a tester, for rays that share nothing. A leaf's triangles
/// are tested straight from their corners by test_quad; what float32 leaves open, and which hit is
/// nearest, is settled by NearestHits: decisions are the same, whatever decides first.
class RaySearch {
 public:
  /// Reports go to `nearest`, counts to `counters`.
  RaySearch(const Bvh& bvh, NearestHits& nearest, HitCounters& counters)
      : bvh_(bvh), nearest_(nearest), counters_(counters) {}

  /// Directions scaled. `nearest` has been reset for these rays.
  void trace(std::span<const Ray> rays, const SearchWishes& wishes);

  /// Rays that SearchWishes::enough_before has ended before their time.
  [[nodiscard]] std::uint64_t ended_early() const { return ended_early_; }

  struct Walk;  ///< a ray on its way

 private:
  friend void walk_ray(RaySearch& search, Walk& walk);

  bool settle(Walk& walk, std::uint32_t slot, bool sure);
  void add_point(std::uint32_t number, std::span<const Ray> rays);
  void add_points(std::span<const Ray> rays);

  const Bvh& bvh_;
  NearestHits& nearest_;
  HitCounters& counters_;
  SearchWishes wishes_;
  std::uint64_t ended_early_ = 0;
  std::array<std::uint32_t, kPlanes> pointless_;  // rays whose P is still to be found
  int pointless_count_ = 0;
};

}  // namespace raygate
