// EarClipper: triangulates polygons by ear clipping with exact predicates.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace raygate {

/// A kd-tree of points in the plane, for finding whether a triangle contains any of them. Points
/// can be removed, not added. Building it for n points takes O(n log n); a query with a thin or
/// small triangle visits far fewer than n points. All predicates are exact.
class PointTree {
 public:
  struct Point {
    glm::vec2 position;
    std::uint32_t id;
  };

  /// Replaces the points. Their ids are unique and less than `id_limit`.
  void build(std::span<const Point> points, std::size_t id_limit);

  /// Removes the point with this id, which must be in the tree.
  void remove(std::uint32_t id);

  /// Returns whether a point is inside the counter-clockwise triangle or on its border, except at
  /// the triangle's corners.
  [[nodiscard]] bool any_in_triangle(const std::array<glm::vec2, 3>& triangle) const;

 private:
  /// The root of a subtree.
  struct Node {
    Point point;
    glm::vec2 low, high;          // the box of the whole subtree
    std::uint32_t present_below;  // how many of the whole subtree are present
    bool present;
  };
  struct Range;
  struct Question;

  void split(const Range& range);
  [[nodiscard]] bool ask(const Question& question, const Range& range) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> place_;  // id to index into nodes_
};

enum class PolygonKind {
  kSimple,        ///< triangulated; every triangle has the polygon's winding
  kSelfTouching,  ///< crosses or touches itself; the triangles may overlap
  kZeroArea,      ///< has exactly no area; there are no triangles
};

/// Triangulates polygons one after another and reuses its storage.
class EarClipper {
 public:
  /// Triangulates the polygon with these corners (at least three, finite) into triangles(). The
  /// polygon may be concave or not quite flat, and have corners within straight sides or holes that
  /// are joined by a bridge. The triangles have the polygon's winding and use all corners except
  /// repeated ones. A convex quad is cut from its first to its third corner.
  ///
  /// Predicates are exact for the projection along the coordinate axis in which the projected area
  /// is largest, so no triangle has zero area. The time is about n log n for n corners.
  PolygonKind cut(std::span<const glm::vec3> corners);

  /// Returns the triangles of the last cut(), as corner numbers: n - 2 for a simple polygon of n
  /// corners.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> triangles() const {
    return triangles_;
  }

 private:
  struct Corner {
    glm::vec2 position{0.0f};              // projected, so that the polygon runs counter-clockwise
    std::uint32_t number = 0;              // among the polygon's corners
    std::uint32_t previous = 0, next = 0;  // in ring_
    std::uint32_t round = 0;               // round in which a neighbour was cut off last
    bool reflex = false;                   // not strictly convex, so it may lie in an ear
    bool gone = false;
  };

  bool project(std::span<const glm::vec3> corners);
  [[nodiscard]] int turn_at(std::uint32_t corner) const;
  [[nodiscard]] bool is_ear(std::uint32_t corner) const;
  void cut_off(std::uint32_t corner);
  PolygonKind clip_ears();
  void list_all_left();

  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Corner> ring_;
  std::vector<glm::vec2> flat_;
  std::vector<std::uint32_t> candidates_, next_candidates_;
  std::vector<PointTree::Point> reflex_corners_;
  PointTree obstacles_;
  bool mind_obstacles_ = true;
};

}  // namespace raygate
