// Intersectors of tests: the pipelined unit's reference model, and queries of any kind.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate::test {

inline std::unique_ptr<Intersector> model_intersector(const Bvh& bvh) {
  return make_unit_intersector(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<ReferenceBurstUnit>()));
}

/// Returns whether a query is one for nearest().
inline bool with_points(const RayQuery& query) {
  return query.any_hit_before.empty() && query.skip_ids.empty();
}

/// Calls nearest(), or occluded() if the query has options that only it allows.
inline void find(Intersector& intersector, std::span<const Ray> rays, const RayQuery& query,
                 std::span<NearestHit> hits) {
  if (with_points(query)) {
    intersector.nearest(rays, query, hits);
  } else {
    intersector.occluded(rays, query, hits);
  }
}

}  // namespace raygate::test
