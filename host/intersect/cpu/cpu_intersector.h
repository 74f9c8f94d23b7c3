// CPU intersector: intersects rays with triangles without a hit-test unit.
#pragma once

#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Traces rays with a common origin in packets of 64, others one by one. P has the bits of the
/// hit-test unit and is computed once for each nearest hit.
class CpuIntersector : public Intersector {
 public:
  /// `bvh` must outlive this object.
  explicit CpuIntersector(const Bvh& bvh) : Intersector({}), bvh_(bvh) {}

  [[nodiscard]] IntersectCounters counters() const override { return counters_; }

 protected:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;

 private:
  const Bvh& bvh_;
  IntersectCounters counters_;
  std::vector<std::uint32_t> found_;  // rays whose hits need a point
};

/// Intersects rays of one origin in packets, for CpuIntersector. `hits` are initialised to misses;
/// misses are not counted. If the query asks for points, appends the rays that hit to `found`.
void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters,
                   std::vector<std::uint32_t>& found);

/// Replaces `hits` by all hits of `ray` with t < t_max, nearest first, then by triangle index.
/// `t_max` is positive; +infinity: no limit. The direction must be scaled, or is not usable and
/// hits nothing. `point` and `point_error` of the hits are not valid.
void all_hits(const Bvh& bvh, const Ray& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
