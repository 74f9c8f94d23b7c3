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

/// The part of CpuIntersector for incoherent rays. Several rays traverse the BVH interleaved. A
/// leaf's triangles are tested directly from their corners by quad_test. Exact arithmetic resolves
/// doubts of float32 and orders hits, so decisions do not depend on the method.
class SingleRayIntersector {
 public:
  SingleRayIntersector(const Bvh& bvh, IntersectCounters& counters)
      : bvh_(bvh), counters_(counters) {}

  /// Intersects as Intersector::intersect does. `hits` are initialised to misses.
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

  // Number of interleaved rays: enough to hide memory latency, few enough for a 32 KB cache that
  // another thread of the core may share.
  static constexpr int kAtOnce = 24;

  const Bvh& bvh_;
  IntersectCounters& counters_;
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
  std::size_t next_ = 0;                                    // the next ray to start
  std::array<std::uint32_t, kAtOnce + kPlanes> pointless_;  // hits whose P is not computed yet
  int pointless_count_ = 0;
};

}  // namespace raygate
