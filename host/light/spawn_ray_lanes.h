// Where rays go on from that hit triangles with nothing near, several at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "host/base/lanes.h"
#include "host/light/neighbor_clearance.h"

// Which side
//
// X, u and candidate 0, the float nearest to X + u m, are departure.cpp's; X in double is off by
// u / 16 at most on each axis, or nothing is said. With m and X so exact, and no coordinate rounded
// by more than u / 2, candidate 0 is beyond the plane by
//   u / |n|_max - (u / 2 + u / 16) |n|_1 > u (1 - 1.37 * 9 / 16) / |n|_max > 0.
//
// How exact X is: a component of NeighborClearance::normal is off by less than 1, so D = (A - O) .
// N is off by less than |A - O|_max, and I . N by less than 2, as no component of I is larger
// (roundings of the dot products are in kNormalError).
//
// Why nothing is near
//
// Of the exact X let w be the least of the three weights of the vertices, and c the triangle's
// clearance: all other triangles are at least c w - margin away, or farther than spawn_reach,
// or one of the triangle's overlaps (see NeighborClearances), or in the triangle's plane. What
// could make candidate 0 no good is within 8 u of the exact X, and within 5 u of the candidate on
// each axis: the box around it and X as double has it, and 2 u more on every side. 16 u are within
// spawn_reach.
//
// c times a weight is computed from the candidate p, in float, as G . (p - A). G is c times the
// weight's gradient: a vector in the triangle's plane, no longer than 1/8, as c is at most an
// eighth of the least height. So it does not matter that p is u above the plane, and that p is
// rounded changes c w by less than u. With s = |p - A|_1, rounding G, p - A and the dot product
// makes it less than 2^-23 s wrong; the third weight, c less the two others, less than 2^-21 (s +
// c). So nothing is near where
//   c w > 16 u + 2^-20 (s + c) + margin
// (of the 16 u, 8 are enough) and nothing of the overlaps is within 16 u of the candidate.

namespace raygate {

using DoubleLanes = double __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));
using LongLanes = std::int64_t __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));

/// Vectors of so many numbers, and what comparing them gives.
template <int kWidth>
struct SpawnNumbers;
template <>
struct SpawnNumbers<kQuad> {
  using Single = FloatQuad;
  using Real = DoubleQuad;
  using SingleMask = IntQuad;
  using RealMask = LongQuad;
};
template <>
struct SpawnNumbers<kLanes> {
  using Single = FloatLanes;
  using Real = DoubleLanes;
  using SingleMask = IntLanes;
  using RealMask = LongLanes;
};

/// Hits to depart from, so many at a time.
template <int kWidth>
struct SpawnHits {
  using Single = typename SpawnNumbers<kWidth>::Single;
  using Real = typename SpawnNumbers<kWidth>::Real;

  Real normal[3];
  Single length, corner[3], gradient[2][3];  ///< as NeighborClearance has them
  Single origin[3], direction[3];            ///< of the rays
};

namespace spawn {

/// The numbers at byte `offset` of each of four objects: row k has their k-th.
template <class Row, class Object>
RAYGATE_INLINE void columns(const Object* const* objects, std::size_t offset, Row (&rows)[kQuad]) {
#pragma GCC unroll 4
  for (int i = 0; i < kQuad; ++i) {
    std::memcpy(&rows[i], reinterpret_cast<const char*>(objects[i]) + offset, sizeof(Row));
  }
  raygate::transpose(rows);
}

RAYGATE_INLINE void load(const NeighborClearance* const* triangles, const Ray* const* rays,
                         SpawnHits<kQuad>& hits) {
  static_assert(
      offsetof(NeighborClearance, normal) == 0 && offsetof(NeighborClearance, length) == 24 &&
      offsetof(NeighborClearance, corner) == 28 && offsetof(NeighborClearance, gradient) == 40 &&
      sizeof(NeighborClearance) == 64 && sizeof(Ray) == 24);
  DoubleQuad reals[kQuad];
  columns(triangles, 0, reals);
  for (int k = 0; k < 3; ++k) hits.normal[k] = reals[k];
  const auto pairs = reinterpret_cast<FloatLanes>(reals[3]);
  hits.length = __builtin_shufflevector(pairs, pairs, 0, 2, 4, 6);
  hits.corner[0] = __builtin_shufflevector(pairs, pairs, 1, 3, 5, 7);
  FloatQuad words[kQuad];
  columns(triangles, 32, words);
  hits.corner[1] = words[0];
  hits.corner[2] = words[1];
  hits.gradient[0][0] = words[2];
  hits.gradient[0][1] = words[3];
  columns(triangles, 48, words);
  hits.gradient[0][2] = words[0];
  for (int k = 0; k < 3; ++k) hits.gradient[1][k] = words[k + 1];
  columns(rays, 0, words);
  for (int k = 0; k < 3; ++k) hits.origin[k] = words[k];
  columns(rays, 8, words);
  for (int k = 0; k < 3; ++k) hits.direction[k] = words[k + 1];
}

/// Row i: the point of lane i, and a word of it.
RAYGATE_INLINE void store(const FloatQuad (&point)[3], const IntQuad& word, FloatQuad* rows) {
  FloatQuad columns[kQuad] = {point[0], point[1], point[2], reinterpret_cast<FloatQuad>(word)};
  raygate::transpose(columns);
  for (int i = 0; i < kQuad; ++i) rows[i] = columns[i];
}
template <class Quad, class Lanes>
RAYGATE_INLINE void split(const Lanes& both, Quad& a, Quad& b) {
  a = __builtin_shufflevector(both, both, 0, 1, 2, 3);
  b = __builtin_shufflevector(both, both, 4, 5, 6, 7);
}
RAYGATE_INLINE void store(const FloatLanes (&point)[3], const IntLanes& word, FloatQuad* rows) {
  FloatQuad a[3], b[3];
  IntQuad word_a, word_b;
  for (int k = 0; k < 3; ++k) split(point[k], a[k], b[k]);
  split(word, word_a, word_b);
  store(a, word_a, rows);
  store(b, word_b, rows + kQuad);
}

RAYGATE_INLINE void join(const FloatQuad& a, const FloatQuad& b, FloatLanes& both) {
  both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
RAYGATE_INLINE void join(const DoubleQuad& a, const DoubleQuad& b, DoubleLanes& both) {
  both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

RAYGATE_INLINE void load(const NeighborClearance* const* triangles, const Ray* const* rays,
                         SpawnHits<kLanes>& hits) {
  SpawnHits<kQuad> a, b;
  load(triangles, rays, a);
  load(triangles + kQuad, rays + kQuad, b);
  join(a.length, b.length, hits.length);
  for (int k = 0; k < 3; ++k) {
    join(a.normal[k], b.normal[k], hits.normal[k]);
    join(a.corner[k], b.corner[k], hits.corner[k]);
    for (int v = 0; v < 2; ++v) join(a.gradient[v][k], b.gradient[v][k], hits.gradient[v][k]);
    join(a.origin[k], b.origin[k], hits.origin[k]);
    join(a.direction[k], b.direction[k], hits.direction[k]);
  }
}

template <Vectors kCode>
RAYGATE_INLINE void convert(const FloatQuad& from, DoubleQuad& to) {
  widen<kCode>(from, to);
}
template <Vectors kCode>
RAYGATE_INLINE void convert(const FloatLanes& from, DoubleLanes& to) {
  to = __builtin_convertvector(from, DoubleLanes);
}
template <Vectors kCode>
RAYGATE_INLINE void convert(const DoubleQuad& from, FloatQuad& to) {
  to = __builtin_convertvector(from, FloatQuad);
}
template <Vectors kCode>
RAYGATE_INLINE void convert(const DoubleLanes& from, FloatLanes& to) {
  to = __builtin_convertvector(from, FloatLanes);
}
template <Vectors kCode, class From, class To>
RAYGATE_INLINE void convert(const From (&from)[3], To (&to)[3]) {
  for (int k = 0; k < 3; ++k) convert<kCode>(from[k], to[k]);
}

/// How far it is from a float that is not negative to the next one.
RAYGATE_INLINE void step_of(const FloatQuad& x, FloatQuad& step) {
  step = reinterpret_cast<FloatQuad>(reinterpret_cast<IntQuad>(x) + 1) - x;
}
RAYGATE_INLINE void step_of(const FloatLanes& x, FloatLanes& step) {
  step = reinterpret_cast<FloatLanes>(reinterpret_cast<IntLanes>(x) + 1) - x;
}

template <class T>
RAYGATE_INLINE void subtract(const T (&a)[3], const T (&b)[3], T (&result)[3]) {
  for (int k = 0; k < 3; ++k) result[k] = a[k] - b[k];
}
template <class T>
RAYGATE_INLINE void magnitudes(const T (&v)[3], T (&sizes)[3]) {
  for (int k = 0; k < 3; ++k) magnitude(v[k], sizes[k]);
}
template <class T>
RAYGATE_INLINE void largest(const T (&v)[3], T& result) {
  T sizes[3];
  magnitudes(v, sizes);
  result = sizes[0] < sizes[1] ? sizes[1] : sizes[0];
  result = result < sizes[2] ? sizes[2] : result;
}
template <class T>
RAYGATE_INLINE void dot(const T (&u)[3], const T (&v)[3], T& result) {
  result = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

}  // namespace spawn

/// Makes `point` candidate 0 of each hit, on the side that the ray came from where `way` is -1, on
/// the other one where it is 1. It is where the ray goes on from if `is_clear` becomes -1, and no
/// triangle of the overlaps is within `reach` of it.
template <Vectors kCode, int kWidth>
RAYGATE_INLINE void spawn_lanes(const SpawnHits<kWidth>& hits,
                                const typename SpawnNumbers<kWidth>::Single& way, float margin,
                                typename SpawnNumbers<kWidth>::Single (&point)[3],
                                typename SpawnNumbers<kWidth>::Single& reach,
                                typename SpawnNumbers<kWidth>::SingleMask& is_clear) {
  using Single = typename SpawnNumbers<kWidth>::Single;
  using Real = typename SpawnNumbers<kWidth>::Real;
  // X = O + t I, and u.
  Real corner[3], origin[3], direction[3], from_origin[3];
  spawn::convert<kCode>(hits.corner, corner);
  spawn::convert<kCode>(hits.origin, origin);
  spawn::convert<kCode>(hits.direction, direction);
  spawn::subtract(corner, origin, from_origin);
  Real plane, slope, above, below;
  spawn::dot(from_origin, hits.normal, plane);
  spawn::dot(direction, hits.normal, slope);
  magnitude(plane, above);
  magnitude(slope, below);
  const Real inverse = 1.0 / below;
  const Real t = above * inverse;
  Real x[3], step;
  for (int k = 0; k < 3; ++k) x[k] = origin[k] + t * direction[k];
  Single rounded[3], x_size, u;
  spawn::convert<kCode>(x, rounded);
  spawn::largest(rounded, x_size);
  spawn::step_of(x_size, u);
  spawn::convert<kCode>(u, step);

  // How far off X may be, with |I|_max < 2.
  Single origin_range;
  Real origin_size, from_size;
  spawn::largest(hits.origin, origin_range);
  spawn::convert<kCode>(origin_range, origin_size);
  spawn::largest(from_origin, from_size);
  const Real along_ray = t + t;
  const Real error = 0x1p-50 * (origin_size + along_ray) + 2.01 * inverse * (from_size + along_ray);
  const typename SpawnNumbers<kWidth>::RealMask is_sure =
      (below >= 0x1p35) & (16.0 * error <= step);

  // Candidate 0: the normal shows where orient3d is -1.
  Real turn, longest;
  spawn::convert<kCode>(way, turn);
  spawn::largest(hits.normal, longest);
  const Real scale = (plane > 0.0 ? turn : -turn) / longest;
  for (int k = 0; k < 3; ++k)
    spawn::convert<kCode>(x[k] + step * (hits.normal[k] * scale), point[k]);

  // c times its least weight.
  Single length, p[3], second, third, sizes[3], point_size, point_step;
  magnitude(hits.length, length);
  spawn::subtract(point, hits.corner, p);
  spawn::dot(p, hits.gradient[0], second);
  spawn::dot(p, hits.gradient[1], third);
  const Single first = length - second - third;
  Single least = first < second ? first : second;
  least = least < third ? least : third;
  spawn::magnitudes(p, sizes);
  const Single error_of_least = 0x1p-20f * (sizes[0] + sizes[1] + sizes[2] + length) + margin;
  spawn::largest(point, point_size);
  spawn::step_of(point_size, point_step);
  reach = 16.0f * u;
  is_clear = (point_step <= u) & (least > reach + error_of_least) &
             __builtin_convertvector(is_sure, typename SpawnNumbers<kWidth>::SingleMask);
}

}  // namespace raygate
