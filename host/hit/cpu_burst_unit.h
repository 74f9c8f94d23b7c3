// The pipelined unit's twin in the machine's own float arithmetic.
#pragma once

#include "host/hit/burst_unit.h"

namespace raygate {

/// The distance of a hit, and how many floats it may be off: 2^(6 + error).
struct HitDistance {
  float t = 0.0f;
  std::uint32_t error = 0;
};

/// As BurstUnit's t and its error, for a record that the ray surely hits.
[[nodiscard]] HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction);

/// As BurstUnit's P: any NaN is 0x7FC00000.
[[nodiscard]] glm::vec3 plane_point(const PolygonRecord& record, const glm::vec3& direction);

/// The same operations in the same order as the hardware: IEEE 754 makes the bits equal. Needs the
/// machine's default floating-point environment (round to nearest even, subnormals kept).
class CpuBurstUnit : public BurstUnit {
 public:
  void run(std::span<const RayBundle> batch, BurstResults& results) override;
  [[nodiscard]] BurstCounters counters() const override { return counters_; }

 private:
  void run_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                 BurstResults& results);

  BurstCounters counters_;
};

}  // namespace raygate
