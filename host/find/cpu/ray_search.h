// Rays of any origins, tested in place, one by one: no records, no batches.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/find/cpu/ray_walk.h"
#include "host/find/finder.h"
#include "host/find/unit/record_batch.h"
#include "host/tree/bvh.h"

namespace raygate {

/// A part of CpuFinder, for rays that share nothing. Several walk the tree at once, in turns. A
/// leaf's triangles are tested straight from their corners by quad_test; what float32 leaves open,
/// and which hit is nearest, exact arithmetic settles: decisions are the same, whatever decides
/// first.
class RaySearch {
 public:
  RaySearch(const Bvh& bvh, FindCounters& counters) : bvh_(bvh), counters_(counters) {}

  /// As Finder::find. `hits` are empty.
  void trace(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits);

 private:
  LaneMask set_out(RayWalk* const (&walks)[kQuad]);
  void arrive(const RayWalk& walk);
  void walk_all();
  void visit_all();
  bool judge(RayWalk& walk, const Bvh::Child& leaf, const QuadSides& sides, LaneMask open);
  bool settle(RayWalk& walk, std::uint32_t slot, bool sure);
  void add_points(int enough);
  void add_points(std::span<const std::uint32_t> numbers);

  static constexpr int kAtOnce = 48;  // rays that take turns

  const Bvh& bvh_;
  FindCounters& counters_;
  std::span<const Ray> rays_;
  Search search_;
  std::span<NearestHit> hits_;
  std::size_t next_ = 0;                                    // ray to set out
  std::array<std::uint32_t, kAtOnce + kPlanes> pointless_;  // rays whose P is still to be found
  int pointless_count_ = 0;
};

}  // namespace raygate
