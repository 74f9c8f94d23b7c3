// Rays of one origin, tested in place: cones of up to 64 rays walk the tree as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/find/cpu/cone_walk.h"
#include "host/find/cpu/quad_record.h"
#include "host/find/nearest_hits.h"
#include "host/find/search_wishes.h"
#include "host/find/unit/hit_tester.h"
#include "host/find/unit/record_batch.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Finds what a Wavefront finds through a tester, but without batches and without polygon records:
/// what is needed of them is made in float32 when a cone comes to a leaf, and tested while it is at
/// hand, against those of eight groups of eight rays whose cone it meets at all. What float32
/// leaves open is settled by NearestHits: decisions are the same, whatever decides first.
class ConeSearch {
 public:
  /// Reports go to `nearest`, counts to `counters`.
  ConeSearch(const Bvh& bvh, const glm::vec3& origin, NearestHits& nearest, HitCounters& counters)
      : bvh_(bvh), origin_(origin), nearest_(nearest), counters_(counters) {}

  /// All rays begin at the origin. `nearest` has been reset for them.
  void trace(std::span<const Ray> rays, const SearchWishes& wishes);

  /// Rays that SearchWishes::enough_before has ended before their time.
  [[nodiscard]] std::uint64_t ended_early() const { return ended_early_; }

 private:
  /// A triangle that is the nearest hit of some rays.
  struct Seen {
    std::uint32_t slot;
    std::uint64_t rays;
  };

  friend void set_out(const ConeSearch& search, ConeWalk& walk);
  friend void walk_tree(ConeSearch& search, ConeWalk& walk);
  friend void finish(ConeSearch& search, const ConeWalk& walk);

  void test_groups(ConeWalk& walk, const QuadRecord& record, const Bvh::Child& leaf,
                   LaneMask there, std::uint64_t rays, LaneMask& changed);
  void test_rays(ConeWalk& walk, const QuadRecord& record, const Bvh::Child& leaf,
                 LaneMask there, std::uint64_t rays, LaneMask& changed);
  void settle_sides(const Bvh::Child& leaf, QuadRecord& record, LaneMask& there) const;
  bool settle(ConeWalk& walk, int group, int lane, std::int32_t slot, const Interval* sure);
  void put(const ConeWalk& walk, const Seen& seen);
  void put_with_points(const ConeWalk& walk, std::span<const Seen> seen);

  const Bvh& bvh_;
  glm::vec3 origin_;
  NearestHits& nearest_;
  HitCounters& counters_;
  SearchWishes wishes_;
  std::span<const Ray> rays_;
  std::uint64_t ended_early_ = 0;
};

}  // namespace raygate
