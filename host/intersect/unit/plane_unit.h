// Plane unit: the interface of the paper's hit-test unit, which intersects rays and planes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {

/// One test of the paper's unit (equation 10): its seven input words.
struct PlaneTest {
  glm::vec3 direction;  ///< I, any finite floats
  glm::vec3 normal;     ///< H (the record's N)
  float d;              ///< H . V for a vertex V of the polygon, seen from the ray's origin
};

/// Computes P = d I / (I . H) for a stream of tests, in binary32, rounded to nearest even after
/// each operation, in this order: dot = ((0 + Hx Ix) + Hy Iy) + Hz Iz; P[k] = (d I[k]) / dot.
/// A ray parallel to the plane gives infinities or NaN, as IEEE 754 has them.
/// A NaN's bits are always 0x7FC00000. Every implementation gives the same bits.
class PlaneUnit {
 public:
  virtual ~PlaneUnit() = default;

  /// `points[i]` becomes the result of `tests[i]`; both spans have one size.
  virtual void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) = 0;

  /// Simulated clock cycles since construction; 0 where nothing is simulated.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

/// The reference model: BurstUnit's point has the same bits.
class ReferencePlaneUnit : public PlaneUnit {
 public:
  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    std::ranges::transform(tests, points.begin(), [](const PlaneTest& test) {
      return ReferenceBurstUnit().point({.normal = test.normal, .d = test.d}, test.direction);
    });
  }
};

}  // namespace raygate
