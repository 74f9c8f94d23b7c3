// Where a ray meets a polygon's plane: the paper's hit-test unit, as software sees it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

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

}  // namespace raygate
