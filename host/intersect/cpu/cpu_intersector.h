// CPU intersector: tests rays against triangles without a hit-test unit.
#pragma once

#include <vector>

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

/// Replaces `hits` by all hits of `ray` with t < t_max, near before far; ties in t: lower triangle
/// index first. `t_max` is positive, +infinity for all. The direction is scaled; one that is not
/// usable hits nothing. `point` and `point_error` of the hits are not valid.
void all_hits(const Bvh& bvh, const Ray& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
