// EarClipper: triangulates polygons by ear clipping with exact predicates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

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
  PolygonKind cut(std::span<const glm::dvec3> corners);

  /// Returns the triangles of the last cut(), as corner numbers: n - 2 for a simple polygon of n
  /// corners.
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
    glm::dvec2 position, low, high;  // of the corner, and the box of the subtree
    std::uint32_t corner;
  };
  using Ear = std::array<glm::dvec2, 3>;

  bool project(std::span<const glm::dvec3> corners);
  [[nodiscard]] int turn_at(std::uint32_t corner) const;
  void build_tree(std::size_t first, std::size_t last);
  [[nodiscard]] bool has_obstacle(const Ear& ear, std::size_t first, std::size_t last) const;
  [[nodiscard]] bool is_ear(std::uint32_t corner) const;
  void cut_off(std::uint32_t corner);
  PolygonKind clip_ears();
  void list_all_left();

  std::vector<Triangle> triangles_;
  std::vector<Corner> ring_;
  std::vector<glm::dvec2> flat_;
  std::vector<std::uint32_t> candidates_, next_candidates_;
  std::vector<Node> tree_;
  bool mind_obstacles_ = true;
};

}  // namespace raygate
