// Exact signs of sums of doubles, and the two questions of plane geometry that rest on them.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace raygate {

/// A sum of doubles without rounding: a list of doubles of growing magnitude whose bits do not
/// overlap (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997, GROW-EXPANSION with zero elimination). Terms must not overflow.
class ExactSum {
 public:
  void add(double term);
  /// -1, 0 or 1.
  [[nodiscard]] int sign() const;

 private:
  std::vector<double> parts_;
};

/// 1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they are exactly on one line.
/// For all finite floats.
[[nodiscard]] int turn(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c);

/// 1 if the closed polygon's signed area is positive (counter-clockwise), -1 if it is negative, 0
/// if it is exactly zero. For all finite floats. `area` becomes the rounded area.
[[nodiscard]] int area_sign(std::span<const glm::vec2> polygon, double& area);

/// True if the three points are exactly on one line (or coincide). For all finite floats.
[[nodiscard]] bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace raygate
