// Rays of any origins, tested in place, one by one: no records, no batches.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/find/finder.h"
#include "host/find/unit/record_batch.h"
#include "host/tree/bvh.h"

namespace raygate {

/// A part of CpuFinder, for rays that share nothing. A leaf's triangles are tested straight from
/// their corners by test_quad; what float32 leaves open, and which hit is nearest, exact arithmetic
/// settles: decisions are the same, whatever decides first.
class RaySearch {
 public:
  RaySearch(const Bvh& bvh, FindCounters& counters) : bvh_(bvh), counters_(counters) {}

  /// As Finder::find. `hits` are empty.
  void trace(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits);

  struct Walk;  ///< a ray on its way

 private:
  friend void walk_ray(RaySearch& search, Walk& walk);
  friend void visit_all(RaySearch& search, Walk& walk, std::span<const Bvh::Child> leaves);

  bool test_leaf(Walk& walk, const Bvh::Child& leaf);
  bool settle(Walk& walk, std::uint32_t slot, bool sure);
  void add_point(std::uint32_t number);
  void add_points();

  const Bvh& bvh_;
  FindCounters& counters_;
  std::span<const Ray> rays_;
  Search search_;
  std::span<NearestHit> hits_;
  std::array<std::uint32_t, kPlanes> pointless_;  // rays whose P is still to be found
  int pointless_count_ = 0;
};

}  // namespace raygate
