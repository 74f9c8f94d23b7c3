#include "host/bvh/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace raygate {
namespace {

/// Returns the closest point of a triangle (C. Ericson, "Real-Time Collision Detection", 2005,
/// 5.1.5), by the Voronoi regions of corners and edges.
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

/// A child to visit, whose triangles are all at least `bound` away.
struct Waiting {
  double bound;
  Bvh::Child child;
  bool operator<(const Waiting& other) const { return bound > other.bound; }  // the nearest first
};

/// Returns the largest magnitude of the coordinates of the BVH's boxes.
double size_of(const BvhView& tree) {
  double size = 0.0;
  Bvh::Node room;
  const Bvh::Node& root = tree.node(0, room);
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = root.box(i);
    if (low.x > high.x) continue;  // an absent child
    size = std::max({size, largest(glm::dvec3(low)), largest(glm::dvec3(high))});
  }
  return size;
}

/// Searches best first: nearest boxes first, until none can contain a nearer point.
ClosestPoint search(const BvhView& tree, const Bvh& bvh, const glm::dvec3& point) {
  constexpr double kRounding = 1.0 - 0x1p-40;  // of distances in double
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  std::priority_queue<Waiting> waiting;
  for (Waiting nearest{0.0, {0, 0}}; nearest.bound <= best.distance;) {
    const Bvh::Child& child = nearest.child;
    for (std::uint32_t primitive = child.first; primitive < child.first + child.count;
         ++primitive) {
      const glm::dvec3 at = closest_on(bvh.corners_of(primitive), point);
      const double distance = glm::distance(at, point);
      if (distance < best.distance ||
          (distance == best.distance &&
           bvh.triangle_of(primitive) < bvh.triangle_of(best.primitive))) {
        best = {primitive, distance, at};
      }
    }
    if (child.count == 0) {
      Bvh::Node room;
      const Bvh::Node& node = tree.node(child.first, room);
      for (int i = 0; i < Bvh::kWidth; ++i) {
        const auto [low, high] = node.box(i);  // infinite for absent children
        const glm::dvec3 gap =
            glm::max(glm::max(glm::dvec3(low) - point, point - glm::dvec3(high)), 0.0);
        const double bound = kRounding * glm::length(gap);
        if (bound <= best.distance) waiting.push({bound, node.child[i]});
      }
    }
    if (waiting.empty()) break;
    nearest = waiting.top();
    waiting.pop();
  }
  return best;
}

}  // namespace

/// At 2^27 times the BVH's size and more, distances to its triangles differ by less than rounding,
/// so a search would visit the whole BVH. It then starts from a point at that distance in the same
/// direction. The triangle nearest to this point is farther from `point` than the nearest one by
/// less than the rounding of the distance.
ClosestPoint closest_point(const Bvh& bvh, const glm::dvec3& point) {
  const BvhView tree(bvh);
  const double far = 0x1p27 * size_of(tree);
  if (largest(point) <= far) return search(tree, bvh, point);
  ClosestPoint best = search(tree, bvh, point / largest(point) * far);
  const glm::dvec3 way = best.point - point;
  best.distance = std::hypot(way.x, way.y, way.z);
  return best;
}

}  // namespace raygate
