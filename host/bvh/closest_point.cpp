#include "host/bvh/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace raygate {
namespace {

/// Returns the triangle's point closest to `point`: on an edge if `point` lies outside an edge,
/// otherwise the projection of `point`. An accurate normal keeps the result accurate for slivers.
glm::dvec3 closest_on(const Corners& t, const glm::dvec3& point) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 normal = triangle_normal(t);
  glm::dvec3 closest;
  double least = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3], edge = b - a, way = point - a;
    if (glm::dot(glm::cross(edge, way), normal) > 0.0) continue;
    const double along = glm::dot(edge, way), whole = glm::dot(edge, edge);
    const glm::dvec3 at = along <= 0.0 ? a : (along >= whole ? b : a + edge * (along / whole));
    const double distance = glm::distance(at, point);
    if (distance < least) std::tie(closest, least) = std::pair(at, distance);
  }
  if (least < kInfinity) return closest;
  const glm::dvec3 way = point - t[0];
  return t[0] + (way - normal * (glm::dot(way, normal) / glm::dot(normal, normal)));
}

constexpr double kRounding = 1.0 - 0x1p-40;  // covers rounding errors of distances in double

/// Updates `best` with the triangles below a child, nearest boxes first.
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

/// If `point` is farther than 2^27 times the BVH's size, distances to different triangles differ by
/// less than rounding errors, and a search would visit the whole BVH. Instead, the search uses a
/// point at 2^27 times the size in the same direction. The triangle closest to this point is, up to
/// a rounding error of the distance, closest to `point`, too.
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
