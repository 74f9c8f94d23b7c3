// Spawn origins on triangles without near neighbours, several hits at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "host/base/triple.h"
#include "host/light/neighbor_clearance.h"

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

/// Hits at which rays are spawned; T is FloatQuad or FloatLanes.
template <class T>
struct SpawnHits {
  Triple<WideOf<T>> normal;
  T length;
  Triple<T> corner, gradient[2];  ///< in the format of NeighborClearance
  Triple<T> origin, direction;    ///< of the rays
};

namespace spawn {

/// Transposes the numbers at byte `offset` of four objects: row k has the k-th number of each.
template <class Row, class Object>
RAYGATE_INLINE void columns(const Object* const* objects, std::size_t offset, Row (&rows)[kQuad]) {
#pragma GCC unroll 4
  for (int i = 0; i < kQuad; ++i) {
    std::memcpy(&rows[i], reinterpret_cast<const char*>(objects[i]) + offset, sizeof(Row));
  }
  raygate::transpose(rows);
}

RAYGATE_INLINE void load(const NeighborClearance* const* triangles, const Ray* const* rays,
                         SpawnHits<FloatQuad>& hits) {
  static_assert(
      offsetof(NeighborClearance, normal) == 0 && offsetof(NeighborClearance, length) == 24 &&
      offsetof(NeighborClearance, corner) == 28 && offsetof(NeighborClearance, gradient) == 40 &&
      sizeof(NeighborClearance) == 64 && sizeof(Ray) == 24);
  DoubleQuad reals[kQuad];
  columns(triangles, 0, reals);
  hits.normal = {reals[0], reals[1], reals[2]};
  const auto pairs = reinterpret_cast<FloatLanes>(reals[3]);
  hits.length = __builtin_shufflevector(pairs, pairs, 0, 2, 4, 6);
  hits.corner.x = __builtin_shufflevector(pairs, pairs, 1, 3, 5, 7);
  FloatQuad words[kQuad], more[kQuad];
  columns(triangles, 32, words);
  columns(triangles, 48, more);
  hits.corner.y = words[0];
  hits.corner.z = words[1];
  hits.gradient[0] = {words[2], words[3], more[0]};
  hits.gradient[1] = {more[1], more[2], more[3]};
  columns(rays, 0, words);
  hits.origin = {words[0], words[1], words[2]};
  columns(rays, 8, words);
  hits.direction = {words[1], words[2], words[3]};
}

/// Stores the point of lane i and a word of it in row i.
RAYGATE_INLINE void store(const Triple<FloatQuad>& point, const IntQuad& word, FloatQuad* rows) {
  FloatQuad columns[kQuad] = {point.x, point.y, point.z, float_of(word)};
  raygate::transpose(columns);
  for (int i = 0; i < kQuad; ++i) rows[i] = columns[i];
}
RAYGATE_INLINE void store(const Triple<FloatLanes>& point, const IntLanes& word, FloatQuad* rows) {
  store({low_half(point.x), low_half(point.y), low_half(point.z)}, low_half(word), rows);
  store({high_half(point.x), high_half(point.y), high_half(point.z)}, high_half(word),
        rows + kQuad);
}

template <class Quad>
RAYGATE_INLINE auto join(const Triple<Quad>& a, const Triple<Quad>& b) {
  using Lanes = decltype(raygate::join(a.x, b.x));
  return Triple<Lanes>{raygate::join(a.x, b.x), raygate::join(a.y, b.y), raygate::join(a.z, b.z)};
}

RAYGATE_INLINE void load(const NeighborClearance* const* triangles, const Ray* const* rays,
                         SpawnHits<FloatLanes>& hits) {
  SpawnHits<FloatQuad> a, b;
  load(triangles, rays, a);
  load(triangles + kQuad, rays + kQuad, b);
  hits.normal = join(a.normal, b.normal);
  hits.length = raygate::join(a.length, b.length);
  hits.corner = join(a.corner, b.corner);
  for (int v = 0; v < 2; ++v) hits.gradient[v] = join(a.gradient[v], b.gradient[v]);
  hits.origin = join(a.origin, b.origin);
  hits.direction = join(a.direction, b.direction);
}

/// Converts to double.
template <Vectors kCode, class T>
RAYGATE_INLINE WideOf<T> widened(const T& x) {
  if constexpr (std::is_same_v<T, FloatQuad>) {
    return widen<kCode>(x);
  } else {
    return wide(x);
  }
}
template <Vectors kCode, class T>
RAYGATE_INLINE Triple<WideOf<T>> widened(const Triple<T>& x) {
  return {widened<kCode>(x.x), widened<kCode>(x.y), widened<kCode>(x.z)};
}

/// Returns the distance from a non-negative float to the next one.
template <class T>
RAYGATE_INLINE T step_of(const T& x) {
  return float_of(bits_in(x) + 1) - x;
}

/// Returns the largest magnitude.
template <class T>
RAYGATE_INLINE T largest(const Triple<T>& v) {
  return maximum(absolute(v.z), maximum(absolute(v.y), absolute(v.x)));
}

}  // namespace spawn

/// Sets `point` to candidate 0 of each hit, on the incident side if `way` is -1 and on the
/// transmitted side if it is 1. Valid if `is_clear` is -1 and no overlap is within `reach`.
template <Vectors kCode, class T>
RAYGATE_INLINE void spawn_lanes(const SpawnHits<T>& hits, const T& way, float margin,
                                Triple<T>& point, T& reach, MaskOf<T>& is_clear) {
  using Wide = WideOf<T>;
  // X = O + t I, and u.
  const Triple<Wide> origin = spawn::widened<kCode>(hits.origin),
                     direction = spawn::widened<kCode>(hits.direction);
  const Triple<Wide> from_origin = spawn::widened<kCode>(hits.corner) - origin;
  const Wide plane = dot(from_origin, hits.normal), slope = dot(direction, hits.normal);
  const Wide below = absolute(slope), inverse = 1.0 / below;
  const Wide t = absolute(plane) * inverse;
  const Triple<Wide> x = origin + direction * t;
  const T u = spawn::step_of(spawn::largest(narrow(x)));
  const Wide step = spawn::widened<kCode>(u);

  // Error bound of X, with |I|_max < 2.
  const Wide origin_size = spawn::widened<kCode>(spawn::largest(hits.origin)), along_ray = t + t;
  const Wide error = 0x1p-50 * (origin_size + along_ray) +
                     2.01 * inverse * (spawn::largest(from_origin) + along_ray);
  const MaskOf<Wide> is_sure = (below >= 0x1p35) & (16.0 * error <= step);

  // Candidate 0. The normal points to the side where orient3d is -1.
  const Wide turn = spawn::widened<kCode>(way);
  const Wide scale = (plane > 0.0 ? turn : -turn) / spawn::largest(hits.normal);
  point = narrow(x + hits.normal * scale * step);

  // c times the least weight of X.
  const T length = absolute(hits.length);
  const Triple<T> p = point - hits.corner;
  const T second = dot(p, hits.gradient[0]), third = dot(p, hits.gradient[1]);
  const T least = minimum(minimum(T(length - second - third), second), third);
  const T error_of_least =
      0x1p-20f * (absolute(p.x) + absolute(p.y) + absolute(p.z) + length) + margin;
  reach = 16.0f * u;
  is_clear = (spawn::step_of(spawn::largest(point)) <= u) & (least > reach + error_of_least) &
             whole(is_sure);
}

}  // namespace raygate
