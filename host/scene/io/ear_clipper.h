// EarClipper: triangulates polygons by ear clipping with exact predicates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

enum class PolygonKind {
  kSimple,        ///< triangulated; every triangle has the polygon's winding
  kSelfTouching,  ///< crosses or touches itself; the triangles may overlap
  kZeroArea,      ///< has exactly no area; there are no triangles
};

/// Triangulates polygons one after another and reuses its storage.
class EarClipper {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  /// Triangulates the polygon with these corners (at least three, finite) into triangles(). The
  /// polygon may be concave or not quite flat, and have corners within straight sides or holes that
  /// are joined by a bridge. The triangles have the polygon's winding and use all corners except
  /// repeated ones. A convex quad is cut from its first to its third corner.
  ///
  /// Predicates are exact for the projection along the coordinate axis in which the projected area
  /// is largest, so no triangle has zero area. The time is about n log n for n corners.
  PolygonKind cut(std::span<const glm::dvec3> corners) {
    triangles_.clear();
    if (!project(corners)) return PolygonKind::kZeroArea;
    tree_.clear();
    for (std::uint32_t i = 0; i < ring_.size(); ++i) {
      Corner& corner = ring_[i];
      corner.reflex = turn_at(i) <= 0;
      if (corner.reflex) tree_.push_back({corner.position, corner.position, corner.position, i});
    }
    build_tree(0, tree_.size());
    mind_obstacles_ = true;
    return clip_ears();
  }

  /// Returns the triangles of the last cut(), as corner numbers: n - 2 for a simple n-gon.
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

 private:
  struct Corner {
    glm::dvec2 position{0.0};              // projected, so that the polygon runs counter-clockwise
    std::uint32_t number = 0;              // among the polygon's corners
    std::uint32_t previous = 0, next = 0;  // in ring_
    std::uint32_t round = 0;               // round in which a neighbour was cut off last
    bool reflex = false;                   // not strictly convex, so it may lie in an ear
    bool gone = false;
  };
  /// The root of a subtree of the kd-tree of corners that were reflex in the whole polygon.
  struct Node {
    glm::dvec2 position, low, high;  // the corner's position, the subtree's box
    std::uint32_t corner;
  };
  using Ear = std::array<glm::dvec2, 3>;

  /// Returns whether a box and a counter-clockwise triangle are apart: along one of the box's axes,
  /// or because all corners of the box are outside one edge of the triangle.
  static bool are_separate(const Ear& triangle, const glm::dvec2& low, const glm::dvec2& high) {
    const auto& [a, b, c] = triangle;
    const glm::dvec2 least = glm::min(glm::min(a, b), c), most = glm::max(glm::max(a, b), c);
    if (high.x < least.x || high.y < least.y || low.x > most.x || low.y > most.y) return true;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec2 &from = triangle[i], &to = triangle[(i + 1) % 3];
      const glm::dvec2 innermost(to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y);
      if (orient2d(from, to, innermost) < 0) return true;
    }
    return false;
  }

  /// Makes nodes [first, last) a subtree. Its root is the median along their box's longer side.
  void build_tree(std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    glm::dvec2 low = tree_[first].position, high = low;
    for (std::size_t i = first; i < last; ++i) {
      low = glm::min(low, tree_[i].position);
      high = glm::max(high, tree_[i].position);
    }
    const int axis = high.y - low.y > high.x - low.x ? 1 : 0;
    const std::size_t root = first + (last - first) / 2;
    std::nth_element(
        &tree_[first], &tree_[root], tree_.data() + last,
        [axis](const Node& a, const Node& b) { return a.position[axis] < b.position[axis]; });
    tree_[root].low = low;
    tree_[root].high = high;
    build_tree(first, root);
    build_tree(root + 1, last);
  }

  [[nodiscard]] bool has_obstacle(const Ear& ear, std::size_t first, std::size_t last) const {
    if (first == last) return false;
    const std::size_t middle = first + (last - first) / 2;
    const Node& root = tree_[middle];
    if (are_separate(ear, root.low, root.high)) return false;
    const bool is_in_ear = ring_[root.corner].reflex &&
                           std::ranges::find(ear, root.position) == ear.end() &&
                           !are_separate(ear, root.position, root.position);
    if (is_in_ear) return true;
    return has_obstacle(ear, first, middle) || has_obstacle(ear, middle + 1, last);
  }

  /// Fills ring_ with the corners, without repeated ones. Returns false if the polygon has no area.
  bool project(std::span<const glm::dvec3> corners) {
    ring_.clear();
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      if (!ring_.empty() && corners[i] == corners[ring_.back().number]) continue;
      ring_.emplace_back().number = i;
    }
    while (ring_.size() > 1 && corners[ring_.back().number] == corners[ring_[0].number]) {
      ring_.pop_back();
    }

    // Project along the axis that gives the largest area, by keeping two coordinates, in the order
    // that makes the polygon counter-clockwise. No coordinate changes, so predicates stay exact.
    int best_sign = 0;
    double best_area = 0.0;
    int best_axis = 0;
    const auto flatten = [&](int first, int second) {
      flat_.resize(ring_.size());
      for (std::size_t i = 0; i < ring_.size(); ++i) {
        const glm::dvec3& corner = corners[ring_[i].number];
        flat_[i] = glm::dvec2(corner[first], corner[second]);
      }
    };
    for (int axis = 0; axis < 3; ++axis) {
      flatten((axis + 1) % 3, (axis + 2) % 3);
      double area = 0.0;
      const int sign = area_sign(flat_, area);
      if (sign != 0 && (best_sign == 0 || std::abs(area) > best_area)) {
        best_sign = sign;
        best_area = std::abs(area);
        best_axis = axis;
      }
    }
    if (best_sign == 0) return false;
    const int first = (best_axis + 1) % 3;
    const int second = (best_axis + 2) % 3;
    best_sign > 0 ? flatten(first, second) : flatten(second, first);

    const auto size = static_cast<std::uint32_t>(ring_.size());
    for (std::uint32_t i = 0; i < size; ++i) {
      Corner& corner = ring_[i];
      corner.position = flat_[i];
      corner.previous = i == 0 ? size - 1 : i - 1;
      corner.next = i + 1 == size ? 0 : i + 1;
    }
    return true;
  }

  [[nodiscard]] int turn_at(std::uint32_t corner) const {
    const Corner& c = ring_[corner];
    return orient2d(ring_[c.previous].position, c.position, ring_[c.next].position);
  }

  /// An ear is a strictly convex corner whose triangle (with both neighbours) contains no other
  /// corner, not even on the border. Only reflex (or straight) corners need tests. Corners at the
  /// position of one of the triangle's corners are allowed: they belong to a bridge to a hole.
  [[nodiscard]] bool is_ear(std::uint32_t corner) const {
    if (turn_at(corner) <= 0) return false;
    if (!mind_obstacles_) return true;
    const Corner& c = ring_[corner];
    const Ear ear{ring_[c.previous].position, c.position, ring_[c.next].position};
    return !has_obstacle(ear, 0, tree_.size());
  }

  void cut_off(std::uint32_t corner) {
    Corner& c = ring_[corner];
    c.gone = true;
    ring_[c.previous].next = c.next;
    ring_[c.next].previous = c.previous;
    // Cutting off an ear narrows its neighbours, so a reflex corner may become convex, but not vice
    // versa. (Obstacles are ignored when there is no ear, so a reflex corner may be cut off then.)
    for (const std::uint32_t neighbour : {c.previous, c.next}) {
      bool& reflex = ring_[neighbour].reflex;
      reflex = reflex && turn_at(neighbour) <= 0;
    }
  }

  void list_all_left() {
    candidates_.clear();
    for (std::uint32_t i = 1; i <= ring_.size(); ++i) {
      const std::uint32_t corner = i == ring_.size() ? 0 : i;
      if (!ring_[corner].gone) candidates_.push_back(corner);
    }
  }

  /// Each round cuts off ears among the candidates, but no two neighbours: that gives better shapes
  /// than a fan. Neighbours of cut ears are the next candidates. A simple polygon has an ear
  /// (Meisters 1975), also if it has corners on straight sides, which no ear may contain.
  PolygonKind clip_ears() {
    PolygonKind kind = PolygonKind::kSimple;
    std::size_t left = ring_.size();
    list_all_left();
    bool listed_all = true;
    for (std::uint32_t round = 1; left > 3; ++round) {
      next_candidates_.clear();
      for (const std::uint32_t corner : candidates_) {
        if (left == 3) break;
        Corner& c = ring_[corner];
        if (c.gone || c.round == round || !is_ear(corner)) continue;
        triangles_.push_back({ring_[c.previous].number, c.number, ring_[c.next].number});
        cut_off(corner);
        --left;
        for (const std::uint32_t neighbour : {c.previous, c.next}) {
          if (ring_[neighbour].round != round) next_candidates_.push_back(neighbour);
          ring_[neighbour].round = round;
        }
      }
      candidates_.swap(next_candidates_);
      if (!candidates_.empty()) {
        listed_all = false;
      } else if (!listed_all) {
        list_all_left();  // a corner may have become an ear, because an obstacle is gone
        listed_all = true;
      } else if (mind_obstacles_) {
        kind = PolygonKind::kSelfTouching;  // there is no ear, so the polygon is not simple
        mind_obstacles_ = false;
        list_all_left();
      } else {
        break;  // there is no convex corner
      }
    }
    // Add the last three corners or, for a polygon that is not simple, a fan of the remaining ones.
    std::uint32_t first = 0;
    while (ring_[first].gone) ++first;
    const Corner& hub = ring_[first];
    for (std::uint32_t i = hub.next; ring_[i].next != first; i = ring_[i].next) {
      const Corner &a = ring_[i], &b = ring_[a.next];
      const int winding = orient2d(hub.position, a.position, b.position);
      if (winding <= 0) kind = PolygonKind::kSelfTouching;
      if (winding != 0) triangles_.push_back({hub.number, a.number, b.number});
    }
    return kind;
  }

  std::vector<Triangle> triangles_;
  std::vector<Corner> ring_;
  std::vector<glm::dvec2> flat_;
  std::vector<std::uint32_t> candidates_, next_candidates_;
  std::vector<Node> tree_;
  bool mind_obstacles_ = true;
};

}  // namespace raygate
