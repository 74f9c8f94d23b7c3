// Is one of these points in that triangle? A kd-tree that answers without looking at all of them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace raygate {

/// Points of the plane, each with a number. Building n takes O(n log n); a question about a thin
/// or small triangle looks at far fewer than n of them. All decisions are exact.
class PointTree {
 public:
  struct Point {
    glm::vec2 position;
    std::uint32_t id;
  };

  /// Replaces the points.
  void build(std::span<const Point> points);

  /// True if `accept(id)` for a point inside the counter-clockwise triangle or on its border.
  [[nodiscard]] bool any_in_triangle(const std::array<glm::vec2, 3>& triangle,
                                     const std::function<bool(std::uint32_t)>& accept) const;

 private:
  // The subtree of [first, last) has its root in the middle; coordinate `axis` splits it.
  void split(std::size_t first, std::size_t last, int axis);

  struct Question;
  bool ask(const Question& question, std::size_t first, std::size_t last, int axis, glm::vec2 low,
           glm::vec2 high) const;

  std::vector<Point> points_;
  glm::vec2 low_{0.0f}, high_{0.0f};
};

}  // namespace raygate
