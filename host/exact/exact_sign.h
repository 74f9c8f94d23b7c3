// Exact predicates of points: orientation, area's sign, collinearity.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace raygate {

/// 1 if a, b, c orient2d counter-clockwise, -1 if clockwise, 0 if they are exactly on one line.
/// For all finite floats.
[[nodiscard]] int orient2d(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c);

/// 1 if the closed polygon's signed area is positive (counter-clockwise), -1 if it is negative, 0
/// if it is exactly zero. For all finite floats. `area` becomes the rounded area.
[[nodiscard]] int area_sign(std::span<const glm::vec2> polygon, double& area);

/// True if the three points are exactly on one line (or coincide). For all finite floats.
[[nodiscard]] bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace raygate
