#include "host/light/clearance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/tree/box_query.h"

// Why c is a bound
//
// Let T have the vertices v_i, and let another triangle S be given. For any vector a let
// g_i = a.v_i - max a.y over the points y of S, which its vertices give. A point X = sum w_i v_i of
// T has a.X - a.y >= sum w_i g_i for every y of S. Where no g_i is negative, the plane between
// T and S keeps X at least sum w_i g_i / |a| >= w sum g_i / |a| away from S, w being the least
// weight. What counts as not negative may be below 0 by `slack`, for rounding, which margin() makes
// good. Whichever a is tried, the bound holds; those that are tried separate triangles which touch
// in an edge or in a corner.

namespace raygate {
namespace {

constexpr std::size_t kMostNeighbours = 4096;  // of a triangle that is looked at
constexpr double kFarthest = 0x1p-6;           // to look, in parts of the largest coordinate

/// A triangle and the planes that its neighbours are likely to be behind.
class Subject {
 public:
  Subject(const Corners& corners, double slack)
      : corners_(corners),
        from_(corners[0]),
        normal_(unit(triangle_normal(corners))),
        slack_(slack) {
    for (int k = 0; k < 3; ++k) vertex_[k] = glm::dvec3(corners[k]) - from_;
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = vertex_[(k + 1) % 3] - vertex_[k];
      inward_[k] = unit(glm::cross(normal_, edge));
      longest = std::max(longest, glm::length(edge));
    }
    height_ = glm::length(triangle_normal(corners)) / longest;
  }

  [[nodiscard]] double height() const { return height_; }

  /// c as far as `other` is concerned, or at least `enough`.
  [[nodiscard]] double clearance(const Corners& other, double enough) const {
    glm::dvec3 y[3];
    for (int k = 0; k < 3; ++k) y[k] = glm::dvec3(other[k]) - from_;
    double best = 0.0;
    const auto try_axis = [&](const glm::dvec3& axis) {
      best = std::max(best, std::max(apart(axis, y), apart(-axis, y)));
      return best >= enough;
    };
    for (const glm::dvec3& axis : inward_) {
      best = std::max(best, apart(axis, y));
      if (best >= enough) return best;
    }
    if (try_axis(normal_)) return best;
    const glm::dvec3 other_normal = unit(triangle_normal(other));
    if (try_axis(other_normal)) return best;
    for (int j = 0; j < 3; ++j) {
      const glm::dvec3 edge = y[(j + 1) % 3] - y[j];
      if (try_axis(unit(glm::cross(other_normal, edge)))) return best;
      for (int k = 0; k < 3; ++k) {
        if (try_axis(unit(glm::cross(edge, vertex_[(k + 1) % 3] - vertex_[k])))) return best;
      }
    }
    return best;
  }

 private:
  /// 0 where `v` is.
  static glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
  }

  /// The sum of the g_i; 0 where one is negative.
  [[nodiscard]] double apart(const glm::dvec3& axis, const glm::dvec3 (&y)[3]) const {
    const double highest =
        std::max({glm::dot(axis, y[0]), glm::dot(axis, y[1]), glm::dot(axis, y[2])});
    double sum = 0.0;
    for (const glm::dvec3& v : vertex_) {
      const double gap = glm::dot(axis, v) - highest;
      if (!(gap >= -slack_)) return 0.0;
      sum += std::max(gap, 0.0);
    }
    return sum;
  }

  const Corners& corners_;
  glm::dvec3 from_;  // everything is relative to this
  glm::dvec3 vertex_[3], normal_, inward_[3];
  double height_, slack_;
};

/// The largest magnitude of a coordinate in the tree.
float largest_coordinate(const Bvh& bvh) {
  float size = 0.0f;
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = bvh.nodes()[0].box(i);
    if (low.x <= high.x) size = std::max({size, largest(low), largest(high)});
  }
  return size;
}

}  // namespace

bool lies_beyond(const Corners& other, const Corners& hit, int side) {
  return std::ranges::all_of(
      other, [&](const glm::vec3& vertex) { return plane_side(vertex, hit) != side; });
}

// A coordinate along a unit vector, of a difference of two points, is off by less than 2^-49 times
// their largest coordinate.
Clearances::Clearances(const Bvh& bvh)
    : bvh_(bvh),
      margin_(0x1p-45f * largest_coordinate(bvh)),
      slack_(0x1p-47 * largest_coordinate(bvh)),
      known_(std::make_unique_for_overwrite<std::atomic<Sides>[]>(bvh.slot_count())) {
  for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
    known_[slot].store({-1.0f, -1.0f}, std::memory_order_relaxed);
  }
}

Clearances::Sides Clearances::look(std::uint32_t slot) const {
  const Sides sides = found(slot);
  known_[slot].store(sides, std::memory_order_relaxed);
  return sides;
}

Clearances::Sides Clearances::found(std::uint32_t slot) const {
  const Corners& corners = bvh_.corners_of(slot);
  const Subject subject(corners, slack_);
  const double size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  const double farthest = std::min(subject.height(), kFarthest * size) * (1.0 - 0x1p-20);
  if (!(farthest > 0.0)) return {0.0f, 0.0f};
  const glm::dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const glm::dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  glm::vec3 from, to;
  for (int k = 0; k < 3; ++k) {
    from[k] = float_below(low[k] - farthest);
    to[k] = float_above(high[k] + farthest);
  }
  std::vector<std::uint32_t> near;
  slots_near(bvh_, from, to, near);
  if (near.size() > kMostNeighbours) return {0.0f, 0.0f};
  double clear[2] = {farthest, farthest};
  for (const std::uint32_t other_slot : near) {
    if (other_slot == slot) continue;
    const Corners& other = bvh_.corners_of(other_slot);
    const double apart =
        (1.0 - 0x1p-20) * subject.clearance(other, std::max(clear[0], clear[1]) * (1.0 + 0x1p-19));
    for (const int side : {1, -1}) {
      double& least = clear[side == 1 ? 0 : 1];
      if (apart < least && !lies_beyond(other, corners, side)) least = apart;
    }
  }
  return {float_below(clear[0]), float_below(clear[1])};
}

}  // namespace raygate
