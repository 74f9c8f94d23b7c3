#include "host/bvh/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace raygate {
namespace {

/// Returns the closest point of a triangle (C. Ericson, "Real-Time Collision Detection", 2005,
/// 5.1.5), by the Voronoi regions of corners and edges.
glm::dvec3 closest_on(const Corners& corners, const glm::dvec3& point) {
  const auto& [a, b, c] = corners;
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

constexpr double kRounding = 1.0 - 0x1p-40;  // of distances in double

/// Improves `best` by the triangles below a child, nearest boxes first.
void search(const Bvh& bvh, const Bvh::Child& child, const glm::dvec3& point, ClosestPoint& best) {
  for (std::uint32_t primitive = child.first; primitive < child.first + child.count; ++primitive) {
    const glm::dvec3 at = closest_on(bvh.corners_of(primitive), point);
    const double distance = glm::distance(at, point);
    if (distance < best.distance ||
        (distance == best.distance &&
         bvh.triangle_of(primitive) < bvh.triangle_of(best.primitive))) {
      best = {primitive, distance, at};
    }
  }
  if (child.count != 0) return;
  Bvh::Node room;
  const Bvh::Node& node = BvhView(bvh).node(child.first, room);
  std::array<std::pair<double, Bvh::Child>, Bvh::kWidth> below;  // with lower bounds of distances
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = node.box(i);  // infinite for absent children
    const glm::dvec3 gap =
        glm::max(glm::max(glm::dvec3(low) - point, point - glm::dvec3(high)), 0.0);
    below[static_cast<std::size_t>(i)] = {kRounding * glm::length(gap), node.child[i]};
  }
  std::ranges::sort(below, {}, [](const auto& one) { return one.first; });
  for (const auto& [bound, next] : below) {
    if (!(bound <= best.distance) || std::isinf(bound)) return;
    search(bvh, next, point, best);
  }
}

}  // namespace

/// At 2^27 times the BVH's size and more, distances to its triangles differ by less than rounding,
/// so a search would visit the whole BVH. It then starts from a point at that distance in the same
/// direction. The triangle nearest to this point is farther from `point` than the nearest one by
/// less than the rounding of the distance.
ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point) {
  Bvh::Node room;
  const auto [low, high] = BvhView(bvh).node(0, room).box();
  const double far = 0x1p27 * std::max(largest(low), largest(high));
  const bool is_far = largest(point) > far;
  ClosestPoint best{.distance = std::numeric_limits<double>::infinity()};
  search(bvh, {0, 0}, is_far ? point / largest(point) * far : point, best);
  if (is_far) {
    const glm::dvec3 way = best.point - point;
    best.distance = std::hypot(way.x, way.y, way.z);
  }
  return best;
}

}  // namespace raygate
