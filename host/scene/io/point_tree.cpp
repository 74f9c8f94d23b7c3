#include "host/scene/io/point_tree.h"

#include <algorithm>

#include "host/exact/exact_sign.h"

namespace raygate {

/// A subtree: nodes [first, last), the root in the middle.
struct PointTree::Range {
  std::size_t first, last;

  [[nodiscard]] bool empty() const { return first == last; }
  [[nodiscard]] std::size_t root() const { return first + (last - first) / 2; }
  [[nodiscard]] Range lower() const { return {first, root()}; }
  [[nodiscard]] Range upper() const { return {root() + 1, last}; }
};

struct PointTree::Question {
  const std::array<glm::vec2, 3>& triangle;

  [[nodiscard]] bool holds(const glm::vec2& point) const {
    for (int i = 0; i < 3; ++i) {
      if (point == triangle[i] || orient2d(triangle[i], triangle[(i + 1) % 3], point) < 0)
        return false;
    }
    return true;
  }

  // Separating axes: true if the box is wholly beside the triangle's own box, or on the outer side
  // of one of its sides (then even the box's corner that is farthest to the inner side is).
  [[nodiscard]] bool misses(const glm::vec2& low, const glm::vec2& high) const {
    for (int axis = 0; axis < 2; ++axis) {
      const auto [least, most] =
          std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
      if (high[axis] < least || low[axis] > most) return true;
    }
    for (int i = 0; i < 3; ++i) {
      const glm::vec2& from = triangle[i];
      const glm::vec2& to = triangle[(i + 1) % 3];
      const glm::vec2 innermost(to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y);
      if (orient2d(from, to, innermost) < 0) return true;
    }
    return false;
  }
};

void PointTree::build(std::span<const Point> points, std::size_t id_limit) {
  nodes_.clear();
  for (const Point& point : points) {
    nodes_.push_back({point, point.position, point.position, 1, true});
  }
  split({0, nodes_.size()});
  place_.resize(id_limit);
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) place_[nodes_[i].point.id] = i;
}

// Puts the median along the box's longer side in the middle, and the rest on its two sides.
void PointTree::split(const Range& range) {
  if (range.last - range.first < 2) return;
  glm::vec2 low = nodes_[range.first].point.position;
  glm::vec2 high = low;
  for (std::size_t i = range.first; i < range.last; ++i) {
    low = glm::min(low, nodes_[i].point.position);
    high = glm::max(high, nodes_[i].point.position);
  }
  const int axis = high.y - low.y > high.x - low.x ? 1 : 0;
  const auto at = [this](std::size_t i) { return nodes_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(range.first), at(range.root()), at(range.last),
                   [axis](const Node& a, const Node& b) {
                     return a.point.position[axis] < b.point.position[axis];
                   });
  Node& root = nodes_[range.root()];
  root.low = low;
  root.high = high;
  root.present_below = static_cast<std::uint32_t>(range.last - range.first);
  split(range.lower());
  split(range.upper());
}

void PointTree::remove(std::uint32_t id) {
  const std::size_t place = place_[id];
  nodes_[place].present = false;
  Range range{0, nodes_.size()};
  while (range.root() != place) {
    --nodes_[range.root()].present_below;
    range = place < range.root() ? range.lower() : range.upper();
  }
  --nodes_[place].present_below;
}

bool PointTree::any_in_triangle(const std::array<glm::vec2, 3>& triangle) const {
  return ask({triangle}, {0, nodes_.size()});
}

bool PointTree::ask(const Question& question, const Range& range) const {
  if (range.empty()) return false;
  const Node& root = nodes_[range.root()];
  if (root.present_below == 0 || question.misses(root.low, root.high)) return false;
  if (root.present && question.holds(root.point.position)) return true;
  return ask(question, range.lower()) || ask(question, range.upper());
}

}  // namespace raygate
