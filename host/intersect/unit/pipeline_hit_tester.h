// Hit tester for the pipelined unit.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate {

/// Everything but the doubts is decided by the unit. What it only reports (doubts, and the farther
/// one of a near tie) gets its P and t here, by the same formulas.
class PipelineHitTester : public HitTester {
 public:
  explicit PipelineHitTester(std::unique_ptr<BurstUnit> unit);

  void run(std::span<const RayBundle> batch, HitResults& results) override;
  void start(std::span<const RayBundle> batch) override;
  void finish(HitResults& results) override;
  [[nodiscard]] std::size_t enough_tests() const override { return unit_->enough_tests(); }
  [[nodiscard]] HitCounters counters() const override;

 private:
  std::unique_ptr<BurstUnit> unit_;
  BurstResults found_;  // kept from batch to batch
};

/// What a burst unit has counted, in a hit tester's terms: three coordinates are a plane test.
[[nodiscard]] HitCounters hit_counters(const BurstCounters& unit);

}  // namespace raygate
