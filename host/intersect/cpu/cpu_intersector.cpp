#include "host/intersect/cpu/cpu_intersector.h"

#include <cassert>

#include "host/base/stopwatch.h"
#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/cpu/single_ray_intersector.h"

namespace raygate {

void CpuIntersector::intersect(std::span<const Ray> rays, const RayQuery& query,
                               std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  Stopwatch watch;
  clear(query, hits);
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  if (query.common_origin && query.culling && !rays.empty()) {
    PacketIntersector(bvh_, counters_).trace(rays, query, hits);
  } else {
    SingleRayIntersector(bvh_, counters_).trace(rays, query, hits);
  }
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
  counters_.hit_tests += watch.lap();
}

}  // namespace raygate
