// Spawn origins on triangles with nothing near, several hits at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "host/base/lane_math.h"
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

/// Vectors of kWidth numbers, and their masks.
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

/// Hits to spawn rays from, kWidth at a time.
template <int kWidth>
struct SpawnHits {
  using Single = typename SpawnNumbers<kWidth>::Single;
  using Real = typename SpawnNumbers<kWidth>::Real;

  Triple<Real> normal;
  Single length;
  Triple<Single> corner, gradient[2];  ///< as NeighborClearance has them
  Triple<Single> origin, direction;    ///< of the rays
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

/// Row i: the point of lane i, and a word of it.
RAYGATE_INLINE void store(const Triple<FloatQuad>& point, const IntQuad& word, FloatQuad* rows) {
  FloatQuad columns[kQuad] = {point.x, point.y, point.z, reinterpret_cast<FloatQuad>(word)};
  raygate::transpose(columns);
  for (int i = 0; i < kQuad; ++i) rows[i] = columns[i];
}
/// One half of eight lanes.
template <class Quad, int kHalf, class Lanes>
RAYGATE_INLINE Quad half(const Lanes& both) {
  constexpr int k = kQuad * kHalf;
  return __builtin_shufflevector(both, both, k, k + 1, k + 2, k + 3);
}
template <int kHalf>
RAYGATE_INLINE void store_half(const Triple<FloatLanes>& point, const IntLanes& word,
                               FloatQuad* rows) {
  store({half<FloatQuad, kHalf>(point.x), half<FloatQuad, kHalf>(point.y),
         half<FloatQuad, kHalf>(point.z)},
        half<IntQuad, kHalf>(word), rows + std::ptrdiff_t{kHalf} * kQuad);
}
RAYGATE_INLINE void store(const Triple<FloatLanes>& point, const IntLanes& word, FloatQuad* rows) {
  store_half<0>(point, word, rows);
  store_half<1>(point, word, rows);
}

template <class Quad, class Lanes>
RAYGATE_INLINE void join(const Quad& a, const Quad& b, Lanes& both) {
  both = __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
template <class Quad, class Lanes>
RAYGATE_INLINE void join(const Triple<Quad>& a, const Triple<Quad>& b, Triple<Lanes>& both) {
  join(a.x, b.x, both.x);
  join(a.y, b.y, both.y);
  join(a.z, b.z, both.z);
}

RAYGATE_INLINE void load(const NeighborClearance* const* triangles, const Ray* const* rays,
                         SpawnHits<kLanes>& hits) {
  SpawnHits<kQuad> a, b;
  load(triangles, rays, a);
  load(triangles + kQuad, rays + kQuad, b);
  join(a.normal, b.normal, hits.normal);
  join(a.length, b.length, hits.length);
  join(a.corner, b.corner, hits.corner);
  for (int v = 0; v < 2; ++v) join(a.gradient[v], b.gradient[v], hits.gradient[v]);
  join(a.origin, b.origin, hits.origin);
  join(a.direction, b.direction, hits.direction);
}

template <Vectors kCode, class From, class To>
RAYGATE_INLINE void convert(const From& from, To& to) {
  if constexpr (std::is_same_v<From, FloatQuad>) {
    widen<kCode>(from, to);
  } else {
    to = __builtin_convertvector(from, To);
  }
}
template <Vectors kCode, class From, class To>
RAYGATE_INLINE void convert(const Triple<From>& from, Triple<To>& to) {
  convert<kCode>(from.x, to.x);
  convert<kCode>(from.y, to.y);
  convert<kCode>(from.z, to.z);
}

/// How far it is from a float that is not negative to the next one.
template <class Mask, class T>
RAYGATE_INLINE void step_of(const T& x, T& step) {
  step = reinterpret_cast<T>(reinterpret_cast<Mask>(x) + 1) - x;
}

template <class T>
RAYGATE_INLINE Triple<T> magnitudes(const Triple<T>& v) {
  Triple<T> sizes;
  magnitude(v.x, sizes.x);
  magnitude(v.y, sizes.y);
  magnitude(v.z, sizes.z);
  return sizes;
}
template <class T>
RAYGATE_INLINE T largest(const Triple<T>& v) {
  const Triple<T> sizes = magnitudes(v);
  const T of_two = sizes.x < sizes.y ? sizes.y : sizes.x;
  return of_two < sizes.z ? sizes.z : of_two;
}

}  // namespace spawn

/// Makes `point` candidate 0 of each hit, on the side that the ray came from where `way` is -1, on
/// the other one where it is 1. It is where the ray goes on from if `is_clear` becomes -1, and no
/// triangle of the overlaps is within `reach` of it.
template <Vectors kCode, int kWidth>
RAYGATE_INLINE void spawn_lanes(const SpawnHits<kWidth>& hits,
                                const typename SpawnNumbers<kWidth>::Single& way, float margin,
                                Triple<typename SpawnNumbers<kWidth>::Single>& point,
                                typename SpawnNumbers<kWidth>::Single& reach,
                                typename SpawnNumbers<kWidth>::SingleMask& is_clear) {
  using Numbers = SpawnNumbers<kWidth>;
  using Single = typename Numbers::Single;
  using Real = typename Numbers::Real;
  using SingleMask = typename Numbers::SingleMask;
  // X = O + t I, and u.
  Triple<Real> corner, origin, direction;
  spawn::convert<kCode>(hits.corner, corner);
  spawn::convert<kCode>(hits.origin, origin);
  spawn::convert<kCode>(hits.direction, direction);
  const Triple<Real> from_origin = corner - origin;
  const Real plane = dot(from_origin, hits.normal), slope = dot(direction, hits.normal);
  Real above, below;
  magnitude(plane, above);
  magnitude(slope, below);
  const Real inverse = 1.0 / below;
  const Real t = above * inverse;
  const Triple<Real> x = origin + direction * t;
  Triple<Single> rounded;
  Single u;
  Real step;
  spawn::convert<kCode>(x, rounded);
  spawn::step_of<SingleMask>(spawn::largest(rounded), u);
  spawn::convert<kCode>(u, step);

  // How far off X may be, with |I|_max < 2.
  Real origin_size;
  spawn::convert<kCode>(spawn::largest(hits.origin), origin_size);
  const Real along_ray = t + t;
  const Real error = 0x1p-50 * (origin_size + along_ray) +
                     2.01 * inverse * (spawn::largest(from_origin) + along_ray);
  const typename Numbers::RealMask is_sure = (below >= 0x1p35) & (16.0 * error <= step);

  // Candidate 0: the normal shows where orient3d is -1.
  Real turn;
  spawn::convert<kCode>(way, turn);
  const Real scale = (plane > 0.0 ? turn : -turn) / spawn::largest(hits.normal);
  spawn::convert<kCode>(x + hits.normal * scale * step, point);

  // c times its least weight.
  Single length, point_step;
  magnitude(hits.length, length);
  const Triple<Single> p = point - hits.corner;
  const Single second = dot(p, hits.gradient[0]), third = dot(p, hits.gradient[1]);
  const Single first = length - second - third;
  Single least = first < second ? first : second;
  least = least < third ? least : third;
  const Triple<Single> sizes = spawn::magnitudes(p);
  const Single error_of_least = 0x1p-20f * (sizes.x + sizes.y + sizes.z + length) + margin;
  spawn::step_of<SingleMask>(spawn::largest(point), point_step);
  reach = 16.0f * u;
  is_clear = (point_step <= u) & (least > reach + error_of_least) &
             __builtin_convertvector(is_sure, SingleMask);
}

}  // namespace raygate
