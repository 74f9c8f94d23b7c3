#include "host/scene/io/ear_clipper.h"

#include <algorithm>
#include <cmath>

#include "host/exact/exact.h"

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

  // Separating axes: the box is disjoint from the triangle's bounds, or all of it, including the
  // corner that is farthest inwards, is on the outer side of an edge.
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

// Partitions the points around the median along the longer side of their box.
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

// Fills ring_ with the corners, without repeated ones. Returns false if the polygon has no area.
bool EarClipper::project(std::span<const glm::vec3> corners) {
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
      const glm::vec3& corner = corners[ring_[i].number];
      flat_[i] = glm::vec2(corner[first], corner[second]);
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

int EarClipper::turn_at(std::uint32_t corner) const {
  const Corner& c = ring_[corner];
  return orient2d(ring_[c.previous].position, c.position, ring_[c.next].position);
}

// An ear is a strictly convex corner whose triangle contains no other corner, not even on its
// border. Only reflex (or straight) corners need to be tested. A corner at the position of one of
// the triangle's corners is allowed: it is the other end of a bridge to a hole.
bool EarClipper::is_ear(std::uint32_t corner) const {
  if (turn_at(corner) <= 0) return false;
  if (!mind_obstacles_) return true;
  const Corner& c = ring_[corner];
  return !obstacles_.any_in_triangle(
      {ring_[c.previous].position, c.position, ring_[c.next].position});
}

void EarClipper::cut_off(std::uint32_t corner) {
  Corner& c = ring_[corner];
  c.gone = true;
  ring_[c.previous].next = c.next;
  ring_[c.next].previous = c.previous;
  // Cutting off an ear narrows its neighbours, so a reflex corner may become convex, but not vice
  // versa. (Obstacles are ignored when there is no ear, so a reflex corner may be cut off then.)
  for (const std::uint32_t neighbour : {c.previous, c.next}) {
    if (!ring_[neighbour].reflex || turn_at(neighbour) <= 0) continue;
    ring_[neighbour].reflex = false;
    obstacles_.remove(neighbour);
  }
}

void EarClipper::list_all_left() {
  candidates_.clear();
  for (std::uint32_t i = 1; i <= ring_.size(); ++i) {
    const std::uint32_t corner = i == ring_.size() ? 0 : i;
    if (!ring_[corner].gone) candidates_.push_back(corner);
  }
}

// Each round cuts off the ears among the candidates, but no two neighbours, which gives better
// shapes than a fan. The neighbours are the candidates of the next round. A simple polygon always
// has an ear (Meisters 1975), also if it has corners on straight sides, which no ear may contain.
PolygonKind EarClipper::clip_ears() {
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
      list_all_left();  // a corner may be an ear since an obstacle is gone
      listed_all = true;
    } else if (mind_obstacles_) {
      kind = PolygonKind::kSelfTouching;  // there is no ear, so the polygon is not simple
      mind_obstacles_ = false;
      list_all_left();
    } else {
      break;  // there is no convex corner
    }
  }
  // The last three corners or, for a polygon that is not simple, a fan of the remaining ones.
  list_all_left();
  if (candidates_.back() == 0) {
    candidates_.pop_back();
    candidates_.insert(candidates_.begin(), 0);
  }
  const Corner& hub = ring_[candidates_[0]];
  for (std::size_t i = 2; i < candidates_.size(); ++i) {
    const Corner& a = ring_[candidates_[i - 1]];
    const Corner& b = ring_[candidates_[i]];
    const int winding = orient2d(hub.position, a.position, b.position);
    if (winding <= 0) kind = PolygonKind::kSelfTouching;
    if (winding != 0) triangles_.push_back({hub.number, a.number, b.number});
  }
  return kind;
}

PolygonKind EarClipper::cut(std::span<const glm::vec3> corners) {
  triangles_.clear();
  if (!project(corners)) return PolygonKind::kZeroArea;
  reflex_corners_.clear();
  for (std::uint32_t i = 0; i < ring_.size(); ++i) {
    ring_[i].reflex = turn_at(i) <= 0;
    if (ring_[i].reflex) reflex_corners_.push_back({ring_[i].position, i});
  }
  obstacles_.build(reflex_corners_, ring_.size());
  mind_obstacles_ = true;
  return clip_ears();
}

}  // namespace raygate
