// Hit testers for the pipelined unit and the paper's unit, simulated or as reference models.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {

/// The pipelined unit decides everything except doubts. P and t of reported tests (doubts, and the
/// farther hit of a near tie) are computed here by the same formulas.
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
  BurstResults found_;  // reused for all batches
};

/// Converts the counts of a burst unit; three coordinates are one plane test.
[[nodiscard]] HitCounters hit_counters(const BurstCounters& unit);

/// The paper's unit intersects a ray with a polygon's plane; software decides whether the point is
/// inside the polygon and which hit is nearest, as in the paper.
class SerialHitTester : public HitTester {
 public:
  /// Pairs that are sent to the unit.
  enum class Order {
    kEdgesFirst,   ///< pairs that the edge planes do not exclude: a miss costs no clocks
    kPlanesFirst,  ///< all pairs, as in the paper
  };

  explicit SerialHitTester(std::unique_ptr<PlaneUnit> unit, Order order = Order::kEdgesFirst);

  void run(std::span<const RayBundle> batch, HitResults& results) override;
  [[nodiscard]] HitCounters counters() const override;

 private:
  /// A (ray, polygon) pair in the unit.
  struct Pair {
    std::uint32_t bundle, lane, record;
    UnitVerdict verdict;
  };

  void collect(std::uint32_t index, const RayBundle& bundle);
  void report_burst(std::span<const RayBundle> batch, std::size_t first, std::size_t last,
                    HitResults& results);

  std::unique_ptr<PlaneUnit> unit_;
  Order order_;
  HitCounters counters_;
  // Reused for all batches.
  std::vector<Pair> pairs_;  // ordered by bundle, lane and record
  std::vector<PlaneTest> plane_tests_;
  std::vector<glm::vec3> points_;
};

}  // namespace raygate
