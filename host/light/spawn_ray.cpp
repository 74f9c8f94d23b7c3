#include "host/light/spawn_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "host/bvh/closest_point.h"
#include "host/light/spawn_ray_lanes.h"

// How far O' is from X
//
// Candidate k is the float nearest to X + 2^k u m, where m is the triangle's normal on the wanted
// side, scaled to a largest component of 1 (later, along the ray). Rounding to float moves each
// coordinate by at most u / 2, as long as no coordinate is rounded at a step larger than u: so by
// (u / 2) |n|_1 along the unit normal n, while the offset moves it by 2^k u / |n|_max. For unit
// vectors |n|_1 |n|_max <= (1 + sqrt(3)) / 2 < 1.37, so already k = 0, with u against 0.69 u, is on
// the right side; the difference, 0.3 u, far exceeds the error of X in double. If X + u m crosses
// into the next binade its step doubles, and k = 1 suffices.

namespace raygate {
namespace {

constexpr int kLastStep = 24;  // 2^24 steps: the magnitude of X's coordinate

/// X in double, and the size of a step.
struct HitPoint {
  glm::dvec3 point;
  double error;  // error bound of each coordinate
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

/// Returns whether double precision proves that no point of the triangle is in the box, by the
/// separating axis theorem. The box's own axes have been tested before.
bool surely_apart(const glm::vec3& low, const glm::vec3& high, const Corners& triangle) {
  for (const glm::vec3& corner : triangle) {
    if (corner == glm::clamp(corner, low, high)) return false;
  }
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

/// Returns the side of `other` on which the ray is just before or after it hits `hit`; 0: coplanar.
int side_of_ray(const Ray& ray, const Corners& hit, const Corners& other, SpawnSide side) {
  const int at_hit = plane_side_at_hit(ray, hit, other);
  if (at_hit != 0) return at_hit;
  const int before = orient3d(ray.origin, other);
  return side == SpawnSide::kIncident ? before : -before;
}

}  // namespace

std::optional<glm::vec3> RaySpawner::find(const Ray& ray, std::uint32_t primitive, SpawnSide side) {
  const SpawnQuery query{&ray, primitive, side};
  SpawnOrigin origin;
  find({&query, 1}, {&origin, 1});
  return origin ? std::optional(*origin) : std::nullopt;
}

template <Vectors kCode, class T>
RAYGATE_INLINE void RaySpawner::find_some(const SpawnQuery* queries, SpawnOrigin* origins) {
  constexpr int kWidth = kLanesOf<T>;
  const NeighborClearance* triangles[kWidth];
  const Ray* rays[kWidth];
  IntOf<T> ways;
#pragma GCC unroll 8
  for (int i = 0; i < kWidth; ++i) {
    triangles[i] = &clearance_of(queries[i].primitive, i);
    rays[i] = queries[i].ray;
    ways[i] = queries[i].side == SpawnSide::kIncident ? -1 : 1;
  }
  SpawnHits<T> hits;
  spawn::load(triangles, rays, hits);
  Triple<T> point;
  T reach;
  MaskOf<T> is_clear;
  spawn_lanes<kCode>(hits, narrow(ways), clearances_.margin(), point, reach, is_clear);
  FloatQuad rows[kWidth];
  spawn::store(point, is_clear, rows);
  static_assert(sizeof(SpawnOrigin) == sizeof(FloatQuad));
  std::memcpy(static_cast<void*>(origins), rows, sizeof rows);

  const LaneMask good = sign_mask(is_clear);
  const LaneMask has_overlaps = sign_mask(bits_in(hits.length));
  constexpr LaneMask kAll = (LaneMask{1} << kWidth) - 1;
  LaneMask rest = (~good & kAll) | has_overlaps;
  if (rest == 0) return;
  float reaches[kWidth];
  std::memcpy(reaches, &reach, sizeof reaches);
  for (; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const SpawnQuery& query = queries[i];
    if ((good >> i & 1) != 0) {
      const glm::vec3 plain = *origins[i];
      const auto is_there = [&](std::uint32_t primitive) {
        return !surely_apart(plain - reaches[i], plain + reaches[i], bvh_.corners_of(primitive));
      };
      const Overlaps& overlaps = bvh_.is_instanced(query.primitive)
                                     ? found_[static_cast<std::size_t>(i)].overlaps
                                     : clearances_.overlaps_of(query.primitive);
      if (!overlaps.any_near<kCode>(plain, reaches[i], is_there)) continue;
    }
    const auto origin = search(*query.ray, query.primitive, query.side);
    origins[i] = origin ? SpawnOrigin{*origin, 1} : SpawnOrigin{};
  }
}

void RaySpawner::find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins) {
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kAvx512, FloatLanes, FloatQuad>;
    constexpr std::size_t kWidth = kLanesOf<T>;
    constexpr std::size_t kAhead = 2 * kWidth;  // prefetch distance
    std::size_t first = 0;
    for (; first + kWidth <= queries.size(); first += kWidth) {
      if (first + kAhead + kWidth <= queries.size()) {
        const SpawnQuery* const soon = &queries[first + kAhead];
        for (std::size_t i = 0; i < kWidth; ++i) clearances_.prefetch_again(soon[i].primitive);
      }
      find_some<code(), T>(&queries[first], &origins[first]);
    }
    if (first == queries.size()) return;
    // The remaining queries; the last one fills the unused lanes.
    SpawnQuery last[kWidth];
    SpawnOrigin last_origins[kWidth];
    for (std::size_t i = 0; i < kWidth; ++i) {
      last[i] = queries[std::min(first + i, queries.size() - 1)];
    }
    find_some<code(), T>(last, last_origins);
    std::copy_n(last_origins, queries.size() - first, &origins[first]);
  });
}

const NeighborClearance& RaySpawner::find_clearance(std::uint32_t primitive, std::size_t lane) {
  if (found_.size() <= lane) found_.resize(kLanes);
  return (found_[lane] = clearances_.look(primitive)).clearance;
}

std::optional<glm::vec3> RaySpawner::search(const Ray& ray, std::uint32_t primitive,
                                            SpawnSide side) {
  const Corners& hit = bvh_.corners_of(primitive);
  const Interval t = hit_distance(ray, hit);
  const HitPoint x(ray, t);
  const int before = orient3d(ray.origin, hit);
  const int sign = side == SpawnSide::kIncident ? before : -before;
  const glm::dvec3 normal = triangle_normal(hit);
  // orient3d is positive behind the normal.
  const glm::dvec3 offsets[2] = {
      normal * (-sign / largest(normal)),
      glm::dvec3(ray.direction) * (side == SpawnSide::kIncident ? -1.0 : 1.0)};
  // The same as lies_beyond(other, hit, sign). Most vertices need no cross product: the components
  // of `normal` are accurate to 2^-34 of its 1-norm.
  const double normal_error =
      0x1p-30 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  const auto is_beyond = [&](const Corners& other) {
    return std::ranges::all_of(other, [&](const glm::vec3& vertex) {
      const glm::dvec3 from_vertex = glm::dvec3(hit[0]) - glm::dvec3(vertex);
      const double height = sign * glm::dot(from_vertex, normal);
      const bool is_sure = std::abs(height) > normal_error * largest(from_vertex);
      return is_sure ? height < 0.0 : orient3d(vertex, hit) != sign;
    });
  };
  // The triangle that rejected a candidate often rejects the next one, too: it is tested first, as
  // the boxes may hold thousands of triangles.
  struct Refuser {
    Corners corners;
    int wanted;  // the required side of a candidate
  };
  std::vector<Refuser> refusers;
  const auto good = [&](const glm::vec3& candidate) {
    if (orient3d(candidate, hit) != sign) return false;
    // The box of X and the candidate, enlarged for the error of X and for rounding.
    const glm::dvec3 c(candidate);
    const glm::vec3 low(glm::min(c, x.point) - 2.0 * x.step);
    const glm::vec3 high(glm::max(c, x.point) + 2.0 * x.step);
    const auto is_refused = [&](const Refuser& refuser) {
      return orient3d(candidate, refuser.corners) != refuser.wanted;
    };
    const auto known = std::ranges::find_if(refusers, [&](const Refuser& refuser) {
      ++triangle_tests_;
      return is_refused(refuser) && touches(low, high, refuser.corners) &&
             !surely_apart(low, high, refuser.corners);
    });
    if (known != refusers.end()) {
      std::iter_swap(refusers.begin(), known);
      return false;
    }
    return !any_primitive_near(
        bvh_, low, high, [&](std::uint32_t other_primitive, const Corners& other) {
          ++triangle_tests_;
          if (other_primitive == primitive || is_beyond(other) || surely_apart(low, high, other))
            return false;
          const Refuser refuser{other, side_of_ray(ray, hit, other, side)};
          if (refuser.wanted == 0 || !is_refused(refuser)) return false;
          refusers.push_back(refuser);
          return true;
        });
  };
  for (int k = 0; k <= kLastStep; ++k) {
    for (const glm::dvec3& offset : offsets) {
      const glm::vec3 candidate(x.point + std::ldexp(x.step, k) * offset);
      if (good(candidate)) return candidate;
    }
  }
  // In a sharp corner close to the ray's origin, that origin may be the only valid point.
  if (side == SpawnSide::kIncident && good(ray.origin)) return ray.origin;
  return std::nullopt;
}

bool RaySpawner::leaves(const Ray& ray, std::uint32_t primitive, SpawnSide side,
                        const glm::vec3& direction) const {
  const Corners& hit = bvh_.corners_of(primitive);
  const int towards = orient3d(ray.origin, hit);
  const int sign = direction_side(direction, hit);
  return side == SpawnSide::kIncident ? sign == -towards : sign == towards;
}

}  // namespace raygate
