// Single-ray intersector: interleaved rays of any origins, tested from the triangles' corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/bvh/bvh.h"
#include "host/intersect/cpu/ray_traversal.h"
#include "host/intersect/intersector.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// A part of CpuIntersector, for rays that share nothing. Several walk the tree at once, in turns.
/// A leaf's triangles are tested straight from their corners by quad_test; what float32 leaves
/// open, and which hit is nearest, exact arithmetic settles: decisions are the same, whatever
/// decides first.
class SingleRayIntersector {
 public:
  SingleRayIntersector(const Bvh& bvh, IntersectCounters& counters)
      : bvh_(bvh), counters_(counters) {}

  /// As Intersector::intersect. `hits` are empty.
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits);

 private:
  LaneMask begin(RayTraversal* const (&walks)[kQuad]);
  void finish(const RayTraversal& walk);
  void walk_all();
  void visit_all();
  bool judge(RayTraversal& walk, const Bvh::Child& leaf, const QuadSides& sides, LaneMask open);
  bool resolve(RayTraversal& walk, std::uint32_t primitive, bool sure);
  void add_points(int enough);
  void add_points(std::span<const std::uint32_t> numbers);

  // Rays that take turns: enough to hide what they wait for, few enough for a cache of 32 KB that
  // another thread of the processor may share.
  static constexpr int kAtOnce = 24;

  const Bvh& bvh_;
  IntersectCounters& counters_;
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
  std::size_t next_ = 0;                                    // ray to set out
  std::array<std::uint32_t, kAtOnce + kPlanes> pointless_;  // rays whose P is still to be found
  int pointless_count_ = 0;
};

}  // namespace raygate
