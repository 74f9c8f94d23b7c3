// The plane unit's reference model in the machine's own float arithmetic.
#pragma once

#include "host/intersect/unit/plane_unit.h"

namespace raygate {

/// The same operations in the same order as the hardware: IEEE 754 makes the bits equal. Needs the
/// machine's default floating-point environment (round to nearest even, subnormals kept).
class ReferencePlaneUnit : public PlaneUnit {
 public:
  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;
};

}  // namespace raygate
