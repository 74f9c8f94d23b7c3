// Two plane units side by side: the first bit in which they differ stops the run.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

#include "host/find/unit/plane_unit.h"

namespace raygate {

/// What CheckPlaneUnit throws. Its text is one line, ready to replay: the seven input words in hex
/// in the order of the unit's bus (Ix Iy Iz a b c d), then both results.
class PlaneUnitMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs every test on both units, returns the first one's results, and throws PlaneUnitMismatch
/// at the first test whose results differ in any bit.
class CheckPlaneUnit : public PlaneUnit {
 public:
  CheckPlaneUnit(std::unique_ptr<PlaneUnit> unit, std::unique_ptr<PlaneUnit> reference);

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;
  [[nodiscard]] std::uint64_t clocks() const override;  ///< the first unit's

 private:
  std::unique_ptr<PlaneUnit> unit_;
  std::unique_ptr<PlaneUnit> reference_;
  std::vector<glm::vec3> expected_;
};

}  // namespace raygate
