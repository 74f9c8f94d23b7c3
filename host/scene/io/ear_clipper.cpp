#include "host/scene/io/ear_clipper.h"

#include <cmath>

#include "host/exact/exact_sign.h"

namespace raygate {

// Fills ring_ with the corners, repeated ones left out; false if the polygon has no area.
bool EarClipper::project(std::span<const glm::vec3> corners) {
  ring_.clear();
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (!ring_.empty() && corners[i] == corners[ring_.back().number]) continue;
    ring_.emplace_back().number = i;
  }
  while (ring_.size() > 1 && corners[ring_.back().number] == corners[ring_[0].number]) {
    ring_.pop_back();
  }

  // Project along the axis that leaves the largest area. Two coordinates in the order that makes
  // the polygon counter-clockwise: no number changes, so what follows is exact.
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

// An ear: a strictly convex corner whose triangle holds no other corner, not even on its border.
// Only reflex (or straight) corners need to be looked at. One at the same place as a corner of the
// triangle is not in the way: it is the other end of a bridge to a hole.
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
  // Cutting an ear off only narrows its neighbours: a reflex one may become convex, never the
  // other way round. (Without ears, where a reflex corner may go, nobody minds obstacles.)
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

// Rounds: in each, cut off the ears among the candidates, but no two neighbours (better shapes
// than a fan); the neighbours are the candidates of the next round. A simple polygon always has an
// ear (Meisters 1975; corners on straight sides change nothing, as an ear may not contain them).
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
      list_all_left();  // an obstacle may have gone that was nobody's neighbour
      listed_all = true;
    } else if (mind_obstacles_) {
      kind = PolygonKind::kSelfTouching;  // no ear anywhere: not a simple polygon
      mind_obstacles_ = false;
      list_all_left();
    } else {
      break;  // not one convex corner
    }
  }
  // The last three corners; or, of a polygon that is not simple, a fan of what is left.
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
