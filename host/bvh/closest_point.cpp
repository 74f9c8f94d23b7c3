#include "host/bvh/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/bvh/box_query.h"

namespace raygate {
namespace {

/// The point of a triangle: C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5, by the
/// regions of corners and edges around it.
glm::dvec3 closest_on(const Corners& corners, const glm::dvec3& point) {
  const glm::dvec3 a(corners[0]), b(corners[1]), c(corners[2]);
  const glm::dvec3 ab = b - a, ac = c - a;
  const double d1 = glm::dot(ab, point - a), d2 = glm::dot(ac, point - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = glm::dot(ab, point - b), d4 = glm::dot(ac, point - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double of_c = d1 * d4 - d3 * d2;
  if (of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  const double d5 = glm::dot(ab, point - c), d6 = glm::dot(ac, point - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double of_b = d5 * d2 - d1 * d6;
  if (of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  const double of_a = d3 * d6 - d5 * d4;
  if (of_a <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const double inverse = 1.0 / (of_a + of_b + of_c);
  return a + ab * (of_b * inverse) + ac * (of_c * inverse);
}

float below(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float above(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

}  // namespace

/// Looks at the triangles in a box around the point, first around what is surely there: a corner.
/// Once something is found, nothing beyond its distance can be nearer.
ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point) {
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto look = [&](std::uint32_t primitive, const Corners& corners) {
    const glm::dvec3 at = closest_on(corners, point);
    const double distance = glm::distance(at, point);
    if (distance < best.distance ||
        (distance == best.distance &&
         bvh.triangle_of(primitive) < bvh.triangle_of(best.primitive))) {
      best = {primitive, distance, at};
    }
  };
  look(0, bvh.corners_of(0));
  double radius = best.distance * 0x1p-10;  // grows to what is found, where there is nothing nearer
  while (true) {
    const double reach = std::min(radius, best.distance);
    const glm::vec3 low(below(point.x - reach), below(point.y - reach), below(point.z - reach));
    const glm::vec3 high(above(point.x + reach), above(point.y + reach), above(point.z + reach));
    (void)any_primitive_near(bvh, low, high, [&](std::uint32_t primitive, const Corners& corners) {
      look(primitive, corners);
      return false;
    });
    if (best.distance <= reach) return best;
    radius *= 4.0;
  }
}

}  // namespace raygate
