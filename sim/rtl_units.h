// The simulated hit-test units, behind the interfaces of host/intersect/unit: the paper's unit, one
// test at a time, and arrays of pipelined units.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "sim/arith.h"

namespace raygate {

/// Interface of a Verilated hit_test_unit, with structural or behavioural arithmetic.
class PlaneModel;

/// hw/hit_test/hit_test_unit.sv in binary32, rounded to nearest even. Tests follow each other
/// without a gap: 7 clocks each, and 3 more per call for the last result. Not thread-safe; each
/// thread may have its own.
class RtlPlaneUnit final : public PlaneUnit {
 public:
  explicit RtlPlaneUnit(Arith arith = Arith::kStructural);
  explicit RtlPlaneUnit(std::unique_ptr<PlaneModel> model);  ///< a unit of another format
  ~RtlPlaneUnit() override;

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;
  [[nodiscard]] std::uint64_t clocks() const override;

 private:
  std::unique_ptr<PlaneModel> model_;
};

/// Chances per clock and lane, in 1/256, that no test is offered and that a result is not taken.
struct BurstStalls {
  int no_test = 0, not_taken = 0;
  std::uint64_t seed = 0;
};

/// Interface of a Verilated hit_test_array.
class BurstModel;

/// hit_test_array of up to 32 lanes: one Verilated lane, instantiated many times. Not thread-safe:
/// each thread makes its own.
class RtlBurstUnit : public BurstUnit {
 public:
  /// Throws InputError if the model cannot be built.
  explicit RtlBurstUnit(int lanes, Arith arith = Arith::kStructural,
                        const BurstStalls& stalls = {});
  explicit RtlBurstUnit(std::unique_ptr<BurstModel> model);  ///< an array of another format
  ~RtlBurstUnit() override;

  /// A second batch may be started: in the hardware, its tests follow the first's without a gap.
  void start(std::span<const RayBundle> batch) override;
  void finish(BurstResults& results) override;
  [[nodiscard]] std::size_t enough_tests() const override { return enough_tests_; }
  [[nodiscard]] HitCounters counters() const override;

 private:
  std::unique_ptr<BurstModel> model_;
  std::size_t enough_tests_;
};

}  // namespace raygate
