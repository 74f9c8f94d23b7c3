#include "host/light/departure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/light/plain_departure.h"
#include "host/tree/box_query.h"

// How far O' is from X
//
// Candidate k is the float nearest to X + 2^k u m, m being the triangle's normal towards the side
// wanted, scaled to a largest component of 1 (and then one along the ray). Rounding to float moves
// each coordinate by u / 2 at most, as long as no coordinate is rounded at a step larger than u:
// so by (u / 2) |n|_1 along the unit normal n, while the offset moves it by 2^k u / |n|_max. For
// unit vectors |n|_1 |n|_max <= (1 + sqrt(3)) / 2 < 1.37, so already k = 0, with u against
// 0.69 u, lies on the right side; what is left, 0.3 u, is far more than the error of X in double.
// Where X + u m crosses into the next binade its step doubles, and k = 1 does it.

namespace raygate {
namespace {

constexpr int kLastStep = 24;  // 2^24 steps: as far away as X's coordinate is large

/// X in double, and the size of a step.
struct HitPoint {
  glm::dvec3 point;
  double error;  // of each coordinate, at most
  double step;   // u

  HitPoint(const Ray& ray, const Interval& t) {
    const glm::dvec3 direction(ray.direction), origin(ray.origin);
    const double middle = 0.5 * (t.low + t.high);
    point = origin + middle * direction;
    error = 0x1p-51 * (largest(origin) + largest(middle * direction)) +
            (t.high - t.low) * largest(direction);
    const auto size = static_cast<float>(largest(point));
    const float next = std::nextafter(size, std::numeric_limits<float>::infinity());
    step = std::max(static_cast<double>(next) - static_cast<double>(size), error);
  }
};

/// Whether no point of the triangle is in the box, as far as double can tell for sure. By the
/// theorem of separating axes; the boxes' own axes have been looked at already.
bool surely_apart(const glm::vec3& low, const glm::vec3& high, const Corners& triangle) {
  const glm::dvec3 middle = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
  const glm::dvec3 half = 0.5 * (glm::dvec3(high) - glm::dvec3(low));
  glm::dvec3 v[3];
  double size = largest(middle) + largest(half);
  for (int k = 0; k < 3; ++k) {
    v[k] = glm::dvec3(triangle[k]) - middle;
    size = std::max(size, largest(v[k]));
  }
  const auto separates = [&](const glm::dvec3& axis) {
    const glm::dvec3 p(glm::dot(axis, v[0]), glm::dot(axis, v[1]), glm::dot(axis, v[2]));
    const double reach = glm::dot(half, glm::abs(axis)) + 0x1p-48 * size * largest(axis);
    return std::min({p.x, p.y, p.z}) > reach || std::max({p.x, p.y, p.z}) < -reach;
  };
  if (separates(triangle_normal(triangle))) return true;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge = v[(k + 1) % 3] - v[k];
    if (separates(glm::dvec3(0.0, edge.z, -edge.y)) ||
        separates(glm::dvec3(-edge.z, 0.0, edge.x)) ||
        separates(glm::dvec3(edge.y, -edge.x, 0.0))) {
      return true;
    }
  }
  return false;
}

/// The side of `other` on which the ray is just before or just after it hits `hit`; 0 where it
/// runs in the plane.
int wanted_side(const Ray& ray, const Corners& hit, const Corners& other, Departure way) {
  const int at_hit = plane_side_at_hit(ray, hit, other);
  if (at_hit != 0) return at_hit;
  const int before = plane_side(ray.origin, other);
  return way == Departure::kBefore ? before : -before;
}

/// Hits word by word, as PlainHits has them.
template <int kWidth>
struct PlainWords {
  float words[18][kWidth];

  void put(int i, const Ray& ray, const Corners& corners, Departure way,
           const Clearances::Clearance& clearance) {
    int next = 0;
    const auto add = [&](const glm::vec3& v) {
      for (int k = 0; k < 3; ++k) words[next++][i] = v[k];
    };
    for (const glm::vec3& vertex : corners) add(vertex);
    add(ray.origin);
    add(ray.direction);
    add({way == Departure::kBefore ? -1.0f : 1.0f, clearance.length[0], clearance.length[1]});
  }
};

}  // namespace

bool DeparturePoint::is_free(const Crowd& crowd, const glm::vec3& point, float reach) const {
  return !crowd.any_near(point, reach, [&](std::uint32_t slot) {
    return !surely_apart(point - reach, point + reach, bvh_.corners_of(slot));
  });
}

std::optional<glm::vec3> DeparturePoint::find(const Ray& ray, std::uint32_t slot, Departure way) {
  const Clearances::Clearance clearance = clearances_.of(slot);
  PlainWords<1> words;
  words.put(0, ray, bvh_.corners_of(slot), way, clearance);
  PlainHits<1> hits;
  static_assert(sizeof hits == sizeof words.words);
  std::memcpy(&hits, words.words, sizeof hits);
  float point[3], reach;
  int sure = 0;
  bool clear = false;
  depart_plainly(hits, clearances_.margin(), point, reach, sure, clear);
  const glm::vec3 plain(point[0], point[1], point[2]);
  if (sure != 0 && clear && (!clearance.crowd || is_free(*clearance.crowd, plain, reach))) {
    return plain;
  }
  return search(ray, slot, way);
}

/// As many as a vector has room for, or fewer.
template <int kWidth>
RAYGATE_INLINE void DeparturePoint::find_some(std::span<const DepartureQuestion> questions,
                                              std::span<std::optional<glm::vec3>> origins) {
  PlainWords<kWidth> words;
  const Crowd* crowds[kWidth];
  for (std::size_t i = 0; i < kWidth; ++i) {
    const DepartureQuestion& question = questions[std::min(i, questions.size() - 1)];
    const Clearances::Clearance clearance = clearances_.of(question.slot);
    crowds[i] = clearance.crowd;
    words.put(static_cast<int>(i), *question.ray, bvh_.corners_of(question.slot), question.way,
              clearance);
  }
  PlainHits<kWidth> hits;
  static_assert(sizeof hits == sizeof words.words);
  std::memcpy(&hits, words.words, sizeof hits);
  typename PlainNumbers<kWidth>::Single point[3], reach;
  typename PlainNumbers<kWidth>::RealMask sure;
  typename PlainNumbers<kWidth>::SingleMask clear;
  depart_plainly(hits, clearances_.margin(), point, reach, sure, clear);
  clear &= __builtin_convertvector(sure, typename PlainNumbers<kWidth>::SingleMask);
  const LaneMask good = sign_mask(clear);
  float points[3][kWidth], reaches[kWidth];
  std::memcpy(points, point, sizeof points);
  std::memcpy(reaches, &reach, sizeof reaches);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const glm::vec3 plain(points[0][i], points[1][i], points[2][i]);
    if ((good >> i & 1) != 0 && (!crowds[i] || is_free(*crowds[i], plain, reaches[i]))) {
      origins[i] = plain;
    } else {
      origins[i] = search(*questions[i].ray, questions[i].slot, questions[i].way);
    }
  }
}

void DeparturePoint::find(std::span<const DepartureQuestion> questions,
                          std::span<std::optional<glm::vec3>> origins) {
  in_vectors([&](auto code) RAYGATE_BODY {
    constexpr int kWidth = code() == Vectors::kAvx512 ? kLanes : kQuad;
    for (std::size_t first = 0; first < questions.size(); first += kWidth) {
      const std::size_t count = std::min<std::size_t>(kWidth, questions.size() - first);
      find_some<kWidth>(questions.subspan(first, count), origins.subspan(first, count));
    }
  });
}

std::optional<glm::vec3> DeparturePoint::search(const Ray& ray, std::uint32_t slot, Departure way) {
  const Corners& hit = bvh_.corners_of(slot);
  const Interval t = hit_distance(ray, hit);
  const HitPoint x(ray, t);
  const int before = plane_side(ray.origin, hit);
  const int side = way == Departure::kBefore ? before : -before;
  const glm::dvec3 normal = triangle_normal(hit);
  // plane_side is positive behind the normal.
  const glm::dvec3 offsets[2] = {
      normal * (-side / largest(normal)),
      glm::dvec3(ray.direction) * (way == Departure::kBefore ? -1.0 : 1.0)};
  const auto good = [&](const glm::vec3& candidate) {
    if (plane_side(candidate, hit) != side) return false;
    // The box of X and the candidate, and some room for the error of X and for rounding.
    const glm::dvec3 c(candidate);
    const glm::vec3 low(glm::min(c, x.point) - 2.0 * x.step);
    const glm::vec3 high(glm::max(c, x.point) + 2.0 * x.step);
    slots_near(bvh_, low, high, near_);
    return std::ranges::all_of(near_, [&](std::uint32_t other_slot) {
      const Corners& other = bvh_.corners_of(other_slot);
      if (other_slot == slot || surely_apart(low, high, other)) return true;
      if (lies_beyond(other, hit, side)) return true;
      const int wanted = wanted_side(ray, hit, other, way);
      return wanted == 0 || plane_side(candidate, other) == wanted;
    });
  };
  for (int k = 0; k <= kLastStep; ++k) {
    for (const glm::dvec3& offset : offsets) {
      const glm::vec3 candidate(x.point + std::ldexp(x.step, k) * offset);
      if (good(candidate)) return candidate;
    }
  }
  // Close to a corner from which the ray has hardly come away, its own origin may be all there is.
  if (way == Departure::kBefore && good(ray.origin)) return ray.origin;
  return std::nullopt;
}

bool DeparturePoint::leaves(const Ray& ray, std::uint32_t slot, Departure way,
                            const glm::vec3& direction) const {
  const Corners& hit = bvh_.corners_of(slot);
  const int towards = plane_side(ray.origin, hit);
  const int side = direction_side(direction, hit);
  return way == Departure::kBefore ? side == -towards : side == towards;
}

}  // namespace raygate
