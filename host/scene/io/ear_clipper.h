// Cuts polygons into triangles: ear clipping with exact decisions.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace raygate {

/// A kd-tree of points of the plane, from which points are only removed: is one of them in a
/// triangle? Building n takes O(n log n); a question about a
/// thin or small triangle looks at far fewer than n of them. All decisions are exact.
class PointTree {
 public:
  struct Point {
    glm::vec2 position;
    std::uint32_t id;
  };

  /// Replaces the points. Their ids are different, and less than `id_limit`.
  void build(std::span<const Point> points, std::size_t id_limit);

  /// Takes the point with this id, which must be there, out.
  void remove(std::uint32_t id);

  /// True if a point is inside the counter-clockwise triangle or on its border; one at the same
  /// place as a corner of the triangle does not count.
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
  kSimple,        ///< cut; every triangle keeps the winding (and covers what overlaps twice)
  kSelfTouching,  ///< crosses or touches itself: cut as well as that can be, with overlaps
  kZeroArea,      ///< exactly no area: nothing to cut
};

/// One clipper serves many polygons one after the other, so that its storage is allocated once.
class EarClipper {
 public:
  /// Cuts the polygon with these corners (at least three, any finite floats; concave, not quite
  /// flat, with corners in the middle of straight sides, or holes joined by a bridge as may be)
  /// into triangles() of corner numbers. They keep the polygon's winding and use all of its
  /// corners, but for repeated ones; a convex quad is cut from its first to its third corner.
  ///
  /// The corners are projected along the coordinate axis along which the polygon is largest, and
  /// decided upon there, exactly: no triangle has zero area. Time is near n log n for n corners.
  PolygonKind cut(std::span<const glm::vec3> corners);

  /// What the last cut() left: n - 2 triangles for n corners of a simple polygon.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> triangles() const {
    return triangles_;
  }

 private:
  struct Corner {
    glm::vec2 position{0.0f};              // projected, so that the polygon runs counter-clockwise
    std::uint32_t number = 0;              // among the polygon's corners
    std::uint32_t previous = 0, next = 0;  // in ring_
    std::uint32_t round = 0;               // in which a neighbour was cut off last
    bool reflex = false;  // not a strictly convex corner: may be in the way of an ear
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
