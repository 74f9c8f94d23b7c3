// An intersector with the pipelined unit's reference model, and a search function, for tests.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate::test {

inline std::unique_ptr<Intersector> model_intersector(const Bvh& bvh) {
  return make_unit_intersector(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<ReferenceBurstUnit>()));
}

/// Returns whether a query needs points; queries for shadow rays do not.
inline bool with_points(const RayQuery& query) {
  return query.any_hit_before.empty() && query.skip_ids.empty();
}

/// Finds the nearest hits, and their points if the query needs them (with_points()).
inline void find(Intersector& intersector, std::span<const Ray> rays, RayQuery query,
                 std::span<NearestHit> hits) {
  query.with_points = with_points(query);
  intersector.nearest(rays, query, hits);
}

}  // namespace raygate::test
