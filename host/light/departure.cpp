#include "host/light/departure.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/bvh/box_query.h"
#include "host/light/plain_departure.h"

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

}  // namespace

std::optional<glm::vec3> DeparturePoint::find(const Ray& ray, std::uint32_t slot, Departure way) {
  const DepartureQuestion question{&ray, slot, way};
  DepartureOrigin origin;
  find({&question, 1}, {&origin, 1});
  return origin ? std::optional(*origin) : std::nullopt;
}

template <Vectors kCode, int kWidth>
RAYGATE_INLINE void DeparturePoint::find_some(const DepartureQuestion* questions,
                                              DepartureOrigin* origins) {
  const Clearance* triangles[kWidth];
  const Ray* rays[kWidth];
  typename PlainNumbers<kWidth>::SingleMask ways;
#pragma GCC unroll 8
  for (int i = 0; i < kWidth; ++i) {
    triangles[i] = &clearance_of(questions[i].slot, i);
    rays[i] = questions[i].ray;
    ways[i] = questions[i].way == Departure::kBefore ? -1 : 1;
  }
  PlainHits<kWidth> hits;
  plain::load(triangles, rays, hits);
  typename PlainNumbers<kWidth>::Single point[3], reach;
  typename PlainNumbers<kWidth>::SingleMask is_clear;
  depart_plainly<kCode>(hits, __builtin_convertvector(ways, typename PlainNumbers<kWidth>::Single),
                        clearances_.margin(), point, reach, is_clear);
  FloatQuad rows[kWidth];
  plain::store(point, is_clear, rows);
  static_assert(sizeof(DepartureOrigin) == sizeof(FloatQuad));
  std::memcpy(static_cast<void*>(origins), rows, sizeof rows);

  const LaneMask good = sign_mask(is_clear);
  const LaneMask crowded = sign_mask(reinterpret_cast<decltype(ways)>(hits.length));
  constexpr LaneMask kAll = (LaneMask{1} << kWidth) - 1;
  LaneMask rest = (~good & kAll) | crowded;
  if (rest == 0) return;
  float reaches[kWidth];
  std::memcpy(reaches, &reach, sizeof reaches);
  for (; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const DepartureQuestion& question = questions[i];
    if ((good >> i & 1) != 0) {
      const glm::vec3 plain = *origins[i];
      const auto is_there = [&](std::uint32_t slot) {
        return !surely_apart(plain - reaches[i], plain + reaches[i], bvh_.corners_of(slot));
      };
      const Crowd& crowd = bvh_.is_placed(question.slot) ? found_[static_cast<std::size_t>(i)].crowd
                                                         : clearances_.crowd_of(question.slot);
      if (!crowd.any_near<kCode>(plain, reaches[i], is_there)) continue;
    }
    const auto origin = search(*question.ray, question.slot, question.way);
    origins[i] = origin ? DepartureOrigin{*origin, 1} : DepartureOrigin{};
  }
}

void DeparturePoint::find(std::span<const DepartureQuestion> questions,
                          std::span<DepartureOrigin> origins) {
  in_vectors([&](auto code) RAYGATE_BODY {
    constexpr int kWidth = code() == Vectors::kAvx512 ? kLanes : kQuad;
    constexpr std::size_t kAhead = std::size_t{2} * kWidth;  // to fetch
    std::size_t first = 0;
    for (; first + kWidth <= questions.size(); first += kWidth) {
      if (first + kAhead + kWidth <= questions.size()) {
        const DepartureQuestion* const soon = &questions[first + kAhead];
        for (int i = 0; i < kWidth; ++i) clearances_.prefetch_again(soon[i].slot);
      }
      find_some<code(), kWidth>(&questions[first], &origins[first]);
    }
    if (first == questions.size()) return;
    // The last ones, and one of them in the lanes that are left.
    DepartureQuestion last[kWidth];
    DepartureOrigin last_origins[kWidth];
    for (std::size_t i = 0; i < kWidth; ++i) {
      last[i] = questions[std::min(first + i, questions.size() - 1)];
    }
    find_some<code(), kWidth>(last, last_origins);
    std::copy_n(last_origins, questions.size() - first, &origins[first]);
  });
}

const Clearance& DeparturePoint::find_clearance(std::uint32_t slot, std::size_t lane) {
  if (found_.size() <= lane) found_.resize(kLanes);
  return (found_[lane] = clearances_.look(slot)).clearance;
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
    return !any_slot_near(bvh_, low, high, [&](std::uint32_t other_slot, const Corners& other) {
      if (other_slot == slot || surely_apart(low, high, other)) return false;
      if (lies_beyond(other, hit, side)) return false;
      const int wanted = wanted_side(ray, hit, other, way);
      return wanted != 0 && plane_side(candidate, other) != wanted;
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
