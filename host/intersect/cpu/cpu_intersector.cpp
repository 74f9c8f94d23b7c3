#include "host/intersect/cpu/cpu_intersector.h"

#include <algorithm>
#include <cassert>

#include "host/base/stopwatch.h"
#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/cpu/single_ray_intersector.h"

namespace raygate {

void CpuIntersector::intersect(std::span<const Ray> rays, const RayQuery& search,
                               std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  Stopwatch watch;
  for (NearestHit& hit : hits) hit.slot = NearestHit::kNone;  // the rest has no meaning
  std::ranges::fill(search.work, RayWork{});
  if (search.common_origin && search.culling && !rays.empty()) {
    PacketIntersector(bvh_, counters_).trace(rays, search, hits);
  } else {
    SingleRayIntersector(bvh_, counters_).trace(rays, search, hits);
  }
  counters_.hit_tests += watch.lap();
}

}  // namespace raygate
