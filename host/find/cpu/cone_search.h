// Rays of one origin, tested in place: cones of up to 64 rays walk the tree as one.
#pragma once

#include <cstdint>
#include <span>

#include "host/find/cpu/cone_walk.h"
#include "host/find/cpu/quad_record.h"
#include "host/find/finder.h"
#include "host/tree/bvh.h"

namespace raygate {

/// A part of CpuFinder, for rays of one origin. What is needed of polygon records is made in
/// float32 when a cone comes to a leaf, and tested while it is at hand, against those of eight
/// groups of eight rays whose cone it meets at all. What float32 leaves open exact arithmetic
/// settles: decisions are the same, whatever decides first.
class ConeSearch {
 public:
  ConeSearch(const Bvh& bvh, FindCounters& counters) : bvh_(bvh), counters_(counters) {}

  /// As Finder::find, but always culling. All rays begin at the first one's origin; `hits` are
  /// empty.
  void trace(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits);

 private:
  /// A triangle that is the nearest hit of some rays.
  struct Seen {
    std::uint32_t slot;
    std::uint64_t rays;
  };

  friend void set_out(const ConeSearch& search, ConeWalk& walk);
  friend void walk_tree(ConeSearch& search, ConeWalk& walk);
  friend void finish(ConeSearch& search, const ConeWalk& walk);

  template <Vectors kCode>
  void test_groups(ConeWalk& walk, const QuadRecord& record, const Bvh::Child& leaf, LaneMask there,
                   std::uint64_t rays, LaneMask& changed);
  void test_rays(ConeWalk& walk, const QuadRecord& record, const Bvh::Child& leaf, LaneMask there,
                 std::uint64_t rays, LaneMask& changed);
  void settle_sides(const Bvh::Child& leaf, QuadRecord& record, LaneMask& there) const;
  bool settle(ConeWalk& walk, int group, int lane, std::int32_t slot, const Interval* sure);
  void put(const ConeWalk& walk, const Seen& seen);
  void put_work(const ConeWalk& walk);
  void put_with_points(const ConeWalk& walk, std::span<const Seen> seen);

  const Bvh& bvh_;
  FindCounters& counters_;
  glm::vec3 origin_{0.0f};
  std::span<const Ray> rays_;
  Search search_;
  std::span<NearestHit> hits_;
};

}  // namespace raygate
