#include "host/light/spawn_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "host/base/triple.h"
#include "host/bvh/traversal.h"

// How far O' is from X
//
// Candidate k is the float nearest to X + 2^k u m, where m is the triangle's normal on the wanted
// side, scaled to a largest component of 1 (later, along the ray). Rounding to float moves each
// coordinate by at most u / 2, as long as no coordinate is rounded at a step larger than u: so by
// (u / 2) |n|_1 along the unit normal n, while the offset moves it by 2^k u / |n|_max. For unit
// vectors |n|_1 |n|_max <= (1 + sqrt(3)) / 2 < 1.37, so already k = 0, with u against 0.69 u, is on
// the right side; the difference, 0.3 u, far exceeds the error of X in double. If X + u m crosses
// into the next binade its step doubles, and k = 1 suffices.

// Side of candidate 0
//
// X, u and candidate 0, the float nearest to X + u m, are those of spawn_ray.cpp. The error of X in
// double is at most u / 16 on each axis; otherwise the lane is rejected. With X and m this
// accurate, and no coordinate rounded by more than u / 2, candidate 0 is beyond the plane by
//   u / |n|_max - (u / 2 + u / 16) |n|_1 > u (1 - 1.37 * 9 / 16) / |n|_max > 0.
//
// Error of X: a component of NeighborClearance::normal is off by less than 1, so D = (A - O) . N is
// off by less than |A - O|_max, and I . N by less than 2, as no component of I is larger (rounding
// of the dot products is part of kNormalError).
//
// Why no triangle is near
//
// Let w be the least of the three weights of the exact X, and c the triangle's clearance: all other
// triangles are at least c w - margin away, or farther than spawn_reach, or an overlap of the
// triangle (see NeighborClearances), or in the triangle's plane. Triangles that could invalidate
// candidate 0 are within 8 u of the exact X, and within 5 u of the candidate on each axis: in the
// box around it and X in double, enlarged by 2 u on every side. 16 u are within spawn_reach.
//
// c times a weight is computed from the candidate p, in float, as G . (p - A). G is c times the
// weight's gradient: a vector in the triangle's plane, no longer than 1/8, as c is at most an
// eighth of the least height. So the offset u of p from the plane does not matter, and rounding p
// changes c w by less than u. With s = |p - A|_1, rounding G, p - A and the dot product changes it
// by less than 2^-23 s; the third weight, c minus the two others, by less than 2^-21 (s + c). So no
// triangle is near if
//   c w > 16 u + 2^-20 (s + c) + margin
// (8 of the 16 u suffice) and no overlap is within 16 u of the candidate.

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

/// Four hits at which rays are spawned.
struct SpawnHits {
  Triple<DoubleQuad> normal;  ///< up to `gradient`: in the format of NeighborClearance
  FloatQuad length;
  Triple<FloatQuad> corner, gradient[2];
  Triple<FloatQuad> origin, direction;  ///< of the rays

  RAYGATE_INLINE SpawnHits(const NeighborClearance* const (&triangles)[kQuad],
                           const Ray* const (&rays)[kQuad]) {
    static_assert(
        offsetof(NeighborClearance, normal) == 0 && offsetof(NeighborClearance, length) == 24 &&
        offsetof(NeighborClearance, corner) == 28 && offsetof(NeighborClearance, gradient) == 40 &&
        sizeof(NeighborClearance) == 64 && sizeof(Ray) == 24);
    DoubleQuad reals[kQuad];
    columns(triangles, 0, reals);
    normal = {reals[0], reals[1], reals[2]};
    const auto pairs = reinterpret_cast<FloatLanes>(reals[3]);
    length = __builtin_shufflevector(pairs, pairs, 0, 2, 4, 6);
    corner.x = __builtin_shufflevector(pairs, pairs, 1, 3, 5, 7);
    FloatQuad words[kQuad], more[kQuad];
    columns(triangles, 32, words);
    columns(triangles, 48, more);
    corner.y = words[0];
    corner.z = words[1];
    gradient[0] = {words[2], words[3], more[0]};
    gradient[1] = {more[1], more[2], more[3]};
    columns(rays, 0, words);
    origin = {words[0], words[1], words[2]};
    columns(rays, 8, words);
    direction = {words[1], words[2], words[3]};
  }

 private:
  /// Transposes the numbers at byte `offset` of four objects: row k has the k-th number of each.
  template <class Row, class Object>
  RAYGATE_INLINE static void columns(const Object* const (&objects)[kQuad], std::size_t offset,
                                     Row (&rows)[kQuad]) {
#pragma GCC unroll 4
    for (int i = 0; i < kQuad; ++i) {
      std::memcpy(&rows[i], reinterpret_cast<const char*>(objects[i]) + offset, sizeof(Row));
    }
    transpose(rows);
  }
};

template <Vectors kCode>
RAYGATE_INLINE Triple<DoubleQuad> widened(const Triple<FloatQuad>& x) {
  return {widen<kCode>(x.x), widen<kCode>(x.y), widen<kCode>(x.z)};
}

/// Returns the distance from non-negative floats to the next ones.
RAYGATE_INLINE FloatQuad step_of(const FloatQuad& x) { return float_of(bits_in(x) + 1) - x; }

/// Returns the largest magnitudes.
template <class T>
RAYGATE_INLINE T largest_size(const Triple<T>& v) {
  return maximum(absolute(v.z), maximum(absolute(v.y), absolute(v.x)));
}

/// Sets `point` to candidate 0 of each hit, on the incident side if `way` is -1 and on the
/// transmitted side if it is 1. Valid if `is_clear` is -1 and no overlap is within `reach`.
template <Vectors kCode>
RAYGATE_INLINE void find_candidates(const SpawnHits& hits, const FloatQuad& way, float margin,
                                    Triple<FloatQuad>& point, FloatQuad& reach, IntQuad& is_clear) {
  // X = O + t I, and u.
  const Triple<DoubleQuad> origin = widened<kCode>(hits.origin),
                           direction = widened<kCode>(hits.direction);
  const Triple<DoubleQuad> from_origin = widened<kCode>(hits.corner) - origin;
  const DoubleQuad plane = dot(from_origin, hits.normal), slope = dot(direction, hits.normal);
  const DoubleQuad below = absolute(slope), inverse = 1.0 / below;
  const DoubleQuad t = absolute(plane) * inverse;
  const Triple<DoubleQuad> x = origin + direction * t;
  const FloatQuad u = step_of(largest_size(narrow(x)));
  const DoubleQuad step = widen<kCode>(u);

  // Error bound of X, with |I|_max < 2.
  const DoubleQuad origin_size = widen<kCode>(largest_size(hits.origin)), along_ray = t + t;
  const DoubleQuad error = 0x1p-50 * (origin_size + along_ray) +
                           2.01 * inverse * (largest_size(from_origin) + along_ray);
  const LongQuad is_sure = (below >= 0x1p35) & (16.0 * error <= step);

  // Candidate 0. The normal points to the side where orient3d is -1.
  const DoubleQuad turn = widen<kCode>(way);
  const DoubleQuad scale = (plane > 0.0 ? turn : -turn) / largest_size(hits.normal);
  point = narrow(x + hits.normal * scale * step);

  // c times the least weight of X.
  const FloatQuad length = absolute(hits.length);
  const Triple<FloatQuad> p = point - hits.corner;
  const FloatQuad second = dot(p, hits.gradient[0]), third = dot(p, hits.gradient[1]);
  const FloatQuad least = minimum(minimum(FloatQuad(length - second - third), second), third);
  const FloatQuad error_of_least =
      0x1p-20f * (absolute(p.x) + absolute(p.y) + absolute(p.z) + length) + margin;
  reach = 16.0f * u;
  is_clear =
      (step_of(largest_size(point)) <= u) & (least > reach + error_of_least) & whole(is_sure);
}

}  // namespace

std::optional<glm::vec3> RaySpawner::find(const Ray& ray, std::uint32_t primitive, SpawnSide side) {
  const SpawnQuery query{&ray, primitive, side};
  SpawnOrigin origin;
  find({&query, 1}, {&origin, 1});
  return origin ? std::optional(*origin) : std::nullopt;
}

template <Vectors kCode>
RAYGATE_INLINE void RaySpawner::find_four(const SpawnQuery* queries, SpawnOrigin* origins) {
  const NeighborClearance* triangles[kQuad];
  const Ray* rays[kQuad];
  FloatQuad ways;
#pragma GCC unroll 4
  for (int i = 0; i < kQuad; ++i) {
    const std::uint32_t primitive = queries[i].primitive;
    if (bvh_.is_instanced(primitive)) [[unlikely]] {
      triangles[i] = &(found_[i] = clearances_.compute(primitive)).clearance;
    } else {
      triangles[i] = &clearances_.of(primitive);
    }
    rays[i] = queries[i].ray;
    ways[i] = queries[i].side == SpawnSide::kIncident ? -1.0f : 1.0f;
  }
  const SpawnHits hits(triangles, rays);
  Triple<FloatQuad> point;
  FloatQuad reach;
  IntQuad is_clear;
  find_candidates<kCode>(hits, ways, clearances_.margin(), point, reach, is_clear);
  FloatQuad rows[kQuad] = {point.x, point.y, point.z, float_of(is_clear)};
  transpose(rows);
  static_assert(sizeof(SpawnOrigin) == sizeof(FloatQuad));
  std::memcpy(static_cast<void*>(origins), rows, sizeof rows);

  const LaneMask good = sign_mask(is_clear);
  const LaneMask has_overlaps = sign_mask(bits_in(hits.length));
  constexpr LaneMask kAll = (LaneMask{1} << kQuad) - 1;
  for (LaneMask rest = (~good & kAll) | has_overlaps; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const SpawnQuery& query = queries[i];
    if ((good >> i & 1) != 0) {
      const glm::vec3 plain = *origins[i];
      const float distance = reach[i];
      const auto is_there = [&](std::uint32_t primitive) {
        return !surely_apart(plain - distance, plain + distance, bvh_.corners_of(primitive));
      };
      const Overlaps& overlaps = bvh_.is_instanced(query.primitive)
                                     ? found_[i].overlaps
                                     : clearances_.overlaps_of(query.primitive);
      if (!overlaps.any_near<kCode>(plain, distance, is_there)) continue;
    }
    const auto origin = search(*query.ray, query.primitive, query.side);
    origins[i] = origin ? SpawnOrigin{*origin, 1} : SpawnOrigin{};
  }
}

void RaySpawner::find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins) {
  in_vectors([&](auto code) RAYGATE_BODY {
    constexpr std::size_t kAhead = std::size_t{2} * kQuad;  // prefetch distance
    std::size_t first = 0;
    for (; first + kQuad <= queries.size(); first += kQuad) {
      if (first + kAhead + kQuad <= queries.size()) {
        const SpawnQuery* const soon = &queries[first + kAhead];
        for (std::size_t i = 0; i < kQuad; ++i) clearances_.prefetch_again(soon[i].primitive);
      }
      find_four<code()>(&queries[first], &origins[first]);
    }
    if (first == queries.size()) return;
    // The remaining queries; the last one fills the unused lanes.
    SpawnQuery last[kQuad];
    SpawnOrigin last_origins[kQuad];
    for (std::size_t i = 0; i < kQuad; ++i) {
      last[i] = queries[std::min(first + i, queries.size() - 1)];
    }
    find_four<code()>(last, last_origins);
    std::copy_n(last_origins, queries.size() - first, &origins[first]);
  });
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
