// Is one of these points in that triangle? A kd-tree that answers without looking at all of them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace raygate {

/// A set of points of the plane that only shrinks. Building n takes O(n log n); a question about a
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

}  // namespace raygate
