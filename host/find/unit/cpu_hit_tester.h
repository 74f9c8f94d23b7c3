// The `cpu` engine: the pipelined unit's twin, in batches or in place.
#pragma once

#include <memory>

#include "host/find/unit/cpu_burst_unit.h"
#include "host/find/unit/pipeline_hit_tester.h"

namespace raygate {

/// Batches go through CpuBurstUnit; a caller who prefers to test in place is welcome to.
class CpuHitTester : public PipelineHitTester {
 public:
  CpuHitTester() : PipelineHitTester(std::make_unique<CpuBurstUnit>()) {}

  [[nodiscard]] HitCounters* in_place() override { return &in_place_; }
  [[nodiscard]] HitCounters counters() const override {
    HitCounters counters = PipelineHitTester::counters();
    return counters += in_place_;
  }

 private:
  HitCounters in_place_;
};

}  // namespace raygate
