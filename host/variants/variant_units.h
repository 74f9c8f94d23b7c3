// Reference models in C++ of the hit-test units with a variant's arithmetic.
#pragma once

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/variants/arithmetic.h"

namespace raygate {

/// In binary32, equals ReferenceBurstUnit but is slower.
extern template class BasicReferenceBurstUnit<Arithmetic>;
using VariantBurstUnit = BasicReferenceBurstUnit<Arithmetic>;

/// Implements PlaneUnit in a variant's format, bit-exact to hit_test_unit with these parameters.
/// Rounds inputs to the format first, as the host would.
class VariantPlaneUnit : public PlaneUnit {
 public:
  explicit VariantPlaneUnit(const Arithmetic& math) : math_(math) {}

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;

 private:
  Arithmetic math_;
};

}  // namespace raygate
