// The hit-test units with a variant's arithmetic, in C++: the twins of what is Verilated.
#pragma once

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/variants/arithmetic.h"

namespace raygate {

/// In binary32 it is ReferenceBurstUnit, slower.
extern template class BasicReferenceBurstUnit<Arithmetic>;
using VariantBurstUnit = BasicReferenceBurstUnit<Arithmetic>;

/// PlaneUnit's contract in a variant's format: bit for bit hit_test_unit with these parameters.
/// Tests need not hold numbers of the format: their words are rounded to it first, as the host
/// would.
class VariantPlaneUnit : public PlaneUnit {
 public:
  explicit VariantPlaneUnit(const Arithmetic& math) : math_(math) {}

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;

 private:
  Arithmetic math_;
};

}  // namespace raygate
