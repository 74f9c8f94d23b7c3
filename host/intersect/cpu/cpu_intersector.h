// CPU intersector: tests rays against triangles without a hit-test unit.
#pragma once

#include "host/intersect/intersector.h"

namespace raygate {

/// Rays of a common origin go as cones of 64 (PacketIntersector), others one by one
/// (SingleRayIntersector). P has the bits of the hit-test unit's: computed once for each hit that
/// is found.
class CpuIntersector : public Intersector {
 public:
  /// The tree must outlive this.
  explicit CpuIntersector(const Bvh& bvh) : bvh_(bvh) {}

  void intersect(std::span<const Ray> rays, const RayQuery& query,
                 std::span<NearestHit> hits) override;
  [[nodiscard]] bool filters_hits() const override { return true; }
  [[nodiscard]] IntersectCounters counters() const override { return counters_; }

 private:
  const Bvh& bvh_;
  IntersectCounters counters_;
};

}  // namespace raygate
