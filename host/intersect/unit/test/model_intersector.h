// The pipelined unit's reference model as an intersector.
#pragma once

#include <memory>

#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/intersect/unit/unit_intersector.h"

namespace raygate::test {

inline std::unique_ptr<Intersector> model_intersector(const Bvh& bvh) {
  return std::make_unique<UnitIntersector>(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<ReferenceBurstUnit>()));
}

}  // namespace raygate::test
