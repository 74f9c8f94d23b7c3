// Where a ray goes on from that hits a triangle with nothing near: the same words for one hit and
// for several at a time.
#pragma once

#include <bit>
#include <cstdint>

#include "host/lanes.h"

// Which side
//
// X, u and candidate 0, the float nearest to X + u m, are departure.cpp's; X in double is off by
// u / 16 at most on each axis, or nothing is said. With m and X so exact, and no coordinate rounded
// by more than u / 2, candidate 0 is beyond the plane by
//   u / |n|_max - (u / 2 + u / 16) |n|_1 > u (1 - 1.37 * 9 / 16) / |n|_max > 0.
//
// Why nothing is near
//
// Of the exact X let w be the least of the three weights of the vertices, and c the triangle's
// clearance: all other triangles that matter are at least c w - margin away, or of the triangle's
// crowd (see Clearances). What could make candidate 0 no good is within 8 u of the exact X, and
// within 5 u of the candidate on each axis: the box around it and X as double has it, and 2 u more
// on every side. Weights are computed from the candidate, which along the plane is less than u
// from X; and c is at most an eighth of the triangle's least height, so that they give c w within
// u. They are computed in float, as triple products of differences, of components up to l, and a
// normal m whose largest component is 1: each is off by less than 2^-17 l^2, and they add up to m .
// N, which is at least |N|, the least height times a side longer than l. That makes c w less than
// 2^-20 l wrong, so nothing is near where
//   c w > 16 u + 2^-19 l + margin
// and nothing of the crowd is within 16 u of the candidate.

namespace raygate {

using DoubleQuad = double __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));
using LongQuad = std::int64_t __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));
using DoubleLanes = double __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));
using LongLanes = std::int64_t __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));

/// What numbers are, one or four at a time, and what comparing them gives.
template <int kWidth>
struct PlainNumbers;
template <>
struct PlainNumbers<1> {
  using Single = float;
  using Real = double;
  using SingleMask = bool;
  using RealMask = int;
};
template <>
struct PlainNumbers<kLanes> {
  using Single = FloatLanes;
  using Real = DoubleLanes;
  using SingleMask = IntLanes;
  using RealMask = LongLanes;
};
template <>
struct PlainNumbers<kQuad> {
  using Single = FloatQuad;
  using Real = DoubleQuad;
  using SingleMask = IntQuad;
  using RealMask = LongQuad;
};

/// Hits to depart from, so many at a time.
template <int kWidth>
struct PlainHits {
  using Single = PlainNumbers<kWidth>::Single;

  Single corner[3][3];  ///< [vertex][axis]
  Single origin[3], direction[3];
  Single way;           ///< -1: to the side the ray came from; 1: to the other
  Single clearance[2];  ///< of the side where plane_side is 1, and of the other
};

namespace plain {

RAYGATE_INLINE void convert(float from, double& to) { to = from; }
RAYGATE_INLINE void convert(double from, float& to) { to = static_cast<float>(from); }
RAYGATE_INLINE void convert(const FloatQuad& from, DoubleQuad& to) {
  to = __builtin_convertvector(from, DoubleQuad);
}
RAYGATE_INLINE void convert(const DoubleQuad& from, FloatQuad& to) {
  to = __builtin_convertvector(from, FloatQuad);
}
RAYGATE_INLINE void convert(const FloatLanes& from, DoubleLanes& to) {
  to = __builtin_convertvector(from, DoubleLanes);
}
RAYGATE_INLINE void convert(const DoubleLanes& from, FloatLanes& to) {
  to = __builtin_convertvector(from, FloatLanes);
}
template <class From, class To>
RAYGATE_INLINE void convert(const From (&from)[3], To (&to)[3]) {
  for (int k = 0; k < 3; ++k) convert(from[k], to[k]);
}

/// How far it is from a float that is not negative to the next one.
RAYGATE_INLINE void step_of(float x, float& step) {
  step = std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + 1) - x;
}
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
RAYGATE_INLINE void larger(const T& a, const T& b, T& result) {
  result = a < b ? b : a;
}
template <class T>
RAYGATE_INLINE void largest(const T (&v)[3], T& result) {
  T size[3];
  for (int k = 0; k < 3; ++k) magnitude(v[k], size[k]);
  larger(size[0], size[1], result);
  larger(result, size[2], result);
}

template <class T>
RAYGATE_INLINE void dot(const T (&u)[3], const T (&v)[3], T& result) {
  result = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

/// u . (v x w)
template <class T>
RAYGATE_INLINE void triple(const T (&u)[3], const T (&v)[3], const T (&w)[3], T& value) {
  value = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
          u[2] * (v[0] * w[1] - v[1] * w[0]);
}

}  // namespace plain

/// Makes `point` candidate 0 of each hit. It is where the ray goes on from if both `sure` and
/// `clear` become true, or -1 in a lane, and no triangle of the crowd is within `reach` of it.
template <int kWidth>
RAYGATE_INLINE void depart_plainly(const PlainHits<kWidth>& hits, float margin,
                                   typename PlainNumbers<kWidth>::Single (&point)[3],
                                   typename PlainNumbers<kWidth>::Single& reach,
                                   typename PlainNumbers<kWidth>::RealMask& sure,
                                   typename PlainNumbers<kWidth>::SingleMask& clear) {
  using Single = PlainNumbers<kWidth>::Single;
  using Real = PlainNumbers<kWidth>::Real;
  // D = A . N and I . N as in exact.cpp, their errors a little more.
  Real corner[3][3], origin[3], direction[3], to_b[3], to_c[3], from_origin[3], normal[3], size[3];
  for (int v = 0; v < 3; ++v) plain::convert(hits.corner[v], corner[v]);
  plain::convert(hits.origin, origin);
  plain::convert(hits.direction, direction);
  plain::subtract(corner[1], corner[0], to_b);
  plain::subtract(corner[2], corner[0], to_c);
  plain::subtract(corner[0], origin, from_origin);
  cross(to_b, to_c, normal, size);
  Single origin_range, direction_range;
  plain::largest(hits.origin, origin_range);
  plain::largest(hits.direction, direction_range);
  Real origin_size, direction_size, from_size, plane, slope, above, below;
  plain::convert(origin_range, origin_size);
  plain::convert(direction_range, direction_size);
  plain::largest(from_origin, from_size);
  plain::dot(from_origin, normal, plane);
  plain::dot(direction, normal, slope);
  magnitude(plane, above);
  magnitude(slope, below);
  const Real off = 10.0 * 0x1p-53 * (size[0] + size[1] + size[2]);
  const Real plane_error = off * from_size, slope_error = off * direction_size;

  // X = O + t I, and u.
  const Real inverse = 1.0 / below;
  const Real t = above * inverse;
  const Real t_error = 1.001 * (plane_error + t * slope_error) * inverse;
  const Real error =
      0x1p-50 * (origin_size + t * direction_size) + 1.001 * t_error * direction_size;
  Real x[3], step;
  for (int k = 0; k < 3; ++k) x[k] = origin[k] + t * direction[k];
  Single rounded[3], x_size, u;
  plain::convert(x, rounded);
  plain::largest(rounded, x_size);
  plain::step_of(x_size, u);
  plain::convert(u, step);
  sure = (slope_error <= 0x1p-34 * below) & (16.0 * error <= step);

  // Candidate 0: the normal shows where plane_side is -1.
  Real way, longest, unit[3], whole_area;
  plain::convert(hits.way, way);
  plain::largest(normal, longest);
  const Real along = plane > 0.0 ? way : -way;
  const Real scale = along / longest;
  for (int k = 0; k < 3; ++k) {
    unit[k] = normal[k] * scale;
    plain::convert(x[k] + step * unit[k], point[k]);
  }
  plain::dot(unit, normal, whole_area);

  // Its least weight, times m . N.
  Single b[3], c[3], p[3], m[3], turn, whole, first, second, third, least, length, other_length;
  plain::subtract(hits.corner[1], hits.corner[0], b);
  plain::subtract(hits.corner[2], hits.corner[0], c);
  plain::subtract(point, hits.corner[0], p);
  plain::convert(unit, m);
  plain::convert(along, turn);
  plain::convert(whole_area, whole);
  plain::triple(m, p, c, second);
  plain::triple(m, b, p, third);
  first = turn * (whole - second - third);
  second = turn * second;
  third = turn * third;
  least = first < second ? first : second;
  least = least < third ? least : third;
  plain::largest(b, length);
  plain::largest(c, other_length);
  plain::larger(length, other_length, length);
  Single point_size, point_step;
  plain::largest(point, point_size);
  plain::step_of(point_size, point_step);
  reach = 16.0f * u;
  const Single clearance = turn < 0.0f ? hits.clearance[0] : hits.clearance[1];
  clear = (point_step <= u) &
          (clearance * least > (reach + 0x1p-19f * length + margin) * (turn * whole));
}

}  // namespace raygate
