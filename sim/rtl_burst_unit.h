// The pipelined hit-test units in simulation, behind the interface of host/intersect/unit.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "sim/arith.h"

namespace raygate {

/// Chances, in 1/256 a clock and lane, that no test is offered and that a result is not taken.
struct BurstStalls {
  int no_test = 0, not_taken = 0;
  std::uint64_t seed = 0;
};

/// What RtlBurstUnit needs of an array.
class BurstModel;

/// hit_test_array of any number of lanes to 32: one lane, Verilated, many times over. Not for use
/// by two threads at once: each thread makes its own.
class RtlBurstUnit : public BurstUnit {
 public:
  /// Throws InputError where the model can't be built.
  explicit RtlBurstUnit(int lanes, Arith arith = Arith::kStructural,
                        const BurstStalls& stalls = {});
  explicit RtlBurstUnit(std::unique_ptr<BurstModel> model);  ///< of another format
  ~RtlBurstUnit() override;

  /// The tests of the second batch follow those of the first without a gap.
  void start(std::span<const RayBundle> batch) override;
  void finish(BurstResults& results) override;
  [[nodiscard]] std::size_t enough_tests() const override { return enough_tests_; }
  [[nodiscard]] BurstCounters counters() const override;

 private:
  std::unique_ptr<BurstModel> model_;
  std::size_t enough_tests_;
};

}  // namespace raygate
