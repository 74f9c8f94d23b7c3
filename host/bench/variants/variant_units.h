// The hit-test units with a variant's arithmetic, in C++: the twins of what is Verilated.
#pragma once

#include "host/bench/variants/arithmetic.h"
#include "host/hit/burst_unit.h"
#include "host/hit/plane_unit.h"

namespace raygate {

/// What the unit says of a single test before it divides.
enum class UnitVerdict : std::uint8_t { kMiss, kHit, kDoubt };

/// BurstUnit's contract in the format and rounding of `math`: every float of the records, rays and
/// results is a number of that format, "floats" between two distances are its numbers, and the
/// limit of grazing is hit_test_pkg::max_grazing's for it. Bit for bit hit_test_pipeline with these
/// parameters. With binary32 it is CpuBurstUnit, slower.
class VariantBurstUnit : public BurstUnit {
 public:
  explicit VariantBurstUnit(const Arithmetic& math) : math_(math) {}

  void run(std::span<const RayBundle> batch, BurstResults& results) override;
  [[nodiscard]] BurstCounters counters() const override { return counters_; }

  /// The verdict on one test, as in `run`.
  [[nodiscard]] UnitVerdict verdict(const PolygonRecord& record, const glm::vec3& direction) const;

 private:
  void run_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                 BurstResults& results);
  [[nodiscard]] UnitVerdict decide(const PolygonRecord& record, const glm::vec3& direction,
                                   float v) const;

  Arithmetic math_;
  BurstCounters counters_;
};

/// t and how many numbers of the format it may be off, 2^(6 + error): as BurstUnit has them.
struct VariantDistance {
  float t = 0.0f;
  std::uint32_t error = 0;
};
[[nodiscard]] VariantDistance variant_distance(const Arithmetic& math, const PolygonRecord& record,
                                               const glm::vec3& direction);

/// P = (d I) / (I . N).
[[nodiscard]] glm::vec3 variant_point(const Arithmetic& math, const PolygonRecord& record,
                                      const glm::vec3& direction);

/// Whether x has an exponent field that is neither 0 nor the largest.
[[nodiscard]] bool is_normal(const Arithmetic& math, float x);

/// PlaneUnit's contract likewise: bit for bit hit_test_unit with these parameters. Tests need not
/// hold numbers of the format: their words are rounded to it first, as the host would.
class VariantPlaneUnit : public PlaneUnit {
 public:
  explicit VariantPlaneUnit(const Arithmetic& math) : math_(math) {}

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override;

 private:
  Arithmetic math_;
};

}  // namespace raygate
