// The paper's hit-test unit, simulated, as a PlaneUnit.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "sim/arith.h"

namespace raygate {

/// What RtlPlaneUnit needs of a Verilated unit, of either kind of arithmetic.
class PlaneModel;

/// hw/hit_test/hit_test_unit.sv in binary32, rounded to nearest even. Tests go through it back to
/// back: 7 clocks each, and 3 more a call for the last one's result. Not for two threads at once;
/// each may have its own.
class RtlPlaneUnit final : public PlaneUnit {
 public:
  explicit RtlPlaneUnit(Arith arith = Arith::kStructural);
  explicit RtlPlaneUnit(std::unique_ptr<PlaneModel> model);  ///< of another format
  ~RtlPlaneUnit() override;

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;
  [[nodiscard]] std::uint64_t clocks() const override;

 private:
  std::unique_ptr<PlaneModel> model_;
};

}  // namespace raygate
