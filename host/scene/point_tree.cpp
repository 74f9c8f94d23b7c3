#include "host/scene/point_tree.h"

#include <algorithm>
#include <array>

#include "host/scene/exact_sign.h"

namespace raygate {

struct PointTree::Question {
  const std::array<glm::vec2, 3>& triangle;
  const std::function<bool(std::uint32_t)>& accept;

  [[nodiscard]] bool contains(const glm::vec2& point) const {
    for (int i = 0; i < 3; ++i) {
      if (turn(triangle[i], triangle[(i + 1) % 3], point) < 0) return false;
    }
    return true;
  }

  // True if the box is wholly on the outer side of one of the triangle's sides: then even the
  // box's corner that is farthest to the inner side is.
  [[nodiscard]] bool misses(const glm::vec2& low, const glm::vec2& high) const {
    for (int i = 0; i < 3; ++i) {
      const glm::vec2& from = triangle[i];
      const glm::vec2& to = triangle[(i + 1) % 3];
      const glm::vec2 innermost(to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y);
      if (turn(from, to, innermost) < 0) return true;
    }
    return false;
  }
};

void PointTree::build(std::span<const Point> points) {
  points_.assign(points.begin(), points.end());
  if (points_.empty()) return;
  low_ = high_ = points_[0].position;
  for (const Point& point : points_) {
    low_ = glm::min(low_, point.position);
    high_ = glm::max(high_, point.position);
  }
  split(0, points_.size(), 0);
}

void PointTree::split(std::size_t first, std::size_t last, int axis) {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  const auto at = [this](std::size_t i) {
    return points_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(first), at(middle), at(last), [axis](const Point& a, const Point& b) {
    return a.position[axis] < b.position[axis];
  });
  split(first, middle, 1 - axis);
  split(middle + 1, last, 1 - axis);
}

bool PointTree::any_in_triangle(const std::array<glm::vec2, 3>& triangle,
                                const std::function<bool(std::uint32_t)>& accept) const {
  return ask({triangle, accept}, 0, points_.size(), 0, low_, high_);
}

bool PointTree::ask(const Question& question, std::size_t first, std::size_t last, int axis,
                    glm::vec2 low, glm::vec2 high) const {
  if (first == last || question.misses(low, high)) return false;
  const std::size_t middle = first + (last - first) / 2;
  const Point& root = points_[middle];
  if (question.contains(root.position) && question.accept(root.id)) return true;
  glm::vec2 low_of_upper = low;
  glm::vec2 high_of_lower = high;
  low_of_upper[axis] = high_of_lower[axis] = root.position[axis];
  return ask(question, first, middle, 1 - axis, low, high_of_lower) ||
         ask(question, middle + 1, last, 1 - axis, low_of_upper, high);
}

}  // namespace raygate
