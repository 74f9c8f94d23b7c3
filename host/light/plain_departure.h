// Where a ray goes on from that hits a triangle with nothing near: the same words for one hit and
// for four at a time.
#pragma once

#include <bit>
#include <cstdint>

#include "host/lanes.h"

// Why nothing is near
//
// X, u and candidate 0 are departure.cpp's. Of the exact X let w be the least of the three weights
// of the vertices, and c the triangle's clearance: all other triangles that matter are at least
// c w - margin away, or of the triangle's crowd (see Clearances). What could make candidate 0 no
// good is within 11 u of the exact X, and within 5 u of the candidate on each axis: the box around
// it and X as double has it, and 2 u more on every side. As double has it, X is off by u at most on
// each axis, and c is at most the triangle's least height, so that the weights computed of it give
// c w within 2 u. They are computed in float, as triple products of differences, of components up
// to l, and a normal m whose largest component is 1: each is off by less than 2^-17 l^2, and they
// add up to m . N, which is at least |N|, the least height times a side longer than l. That makes
// c w less than 2^-17 l wrong, so nothing is near where
//   c w > 16 u + 2^-16 l + margin
// and no box of the crowd is within 16 u of the candidate.

namespace raygate {

using DoubleQuad = double __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));
using LongQuad = std::int64_t __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));

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
template <class From, class To>
RAYGATE_INLINE void convert(const From (&from)[3], To (&to)[3]) {
  for (int k = 0; k < 3; ++k) convert(from[k], to[k]);
}

/// The next float above one that is not negative.
RAYGATE_INLINE void next_above(float x, float& next) {
  next = std::bit_cast<float>(std::bit_cast<std::int32_t>(x) + 1);
}
RAYGATE_INLINE void next_above(const FloatQuad& x, FloatQuad& next) {
  next = reinterpret_cast<FloatQuad>(reinterpret_cast<IntQuad>(x) + 1);
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

/// u . v, and a bound of its error: v is a cross product with terms of such sizes. As exact.cpp.
template <class T>
RAYGATE_INLINE void dot(const T (&u)[3], const T (&v)[3], const T (&size)[3], T& value, T& error) {
  T far[3];
  for (int k = 0; k < 3; ++k) magnitude(u[k], far[k]);
  value = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  error = 10.0 * 0x1p-53 * (far[0] * size[0] + far[1] * size[1] + far[2] * size[2]);
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
  constexpr double kU = 0x1p-53;
  Real corner[3][3], origin[3], direction[3], way;
  for (int v = 0; v < 3; ++v) plain::convert(hits.corner[v], corner[v]);
  plain::convert(hits.origin, origin);
  plain::convert(hits.direction, direction);
  plain::convert(hits.way, way);

  // As hit_distance: t = D / (I . N) is in [low, high].
  Real to_b[3], to_c[3], from_origin[3], normal[3], size[3];
  plain::subtract(corner[1], corner[0], to_b);
  plain::subtract(corner[2], corner[0], to_c);
  plain::subtract(corner[0], origin, from_origin);
  cross(to_b, to_c, normal, size);
  Real plane, plane_error, above, slope, slope_error, below;
  plain::dot(from_origin, normal, size, plane, plane_error);
  plain::dot(direction, normal, size, slope, slope_error);
  magnitude(plane, above);
  magnitude(slope, below);
  sure = (plane_error <= 0x1p-37 * above) & (slope_error <= 0x1p-37 * below);
  const Real low = (above - plane_error) / (below + slope_error) * (1.0 - 4.0 * kU);
  const Real high = (above + plane_error) / (below - slope_error) * (1.0 + 4.0 * kU);

  // As HitPoint.
  const Real middle = 0.5 * (low + high);
  Real walked[3], x[3], origin_size, walked_size, direction_size, x_size, from, to;
  for (int k = 0; k < 3; ++k) {
    walked[k] = middle * direction[k];
    x[k] = origin[k] + walked[k];
  }
  plain::largest(origin, origin_size);
  plain::largest(walked, walked_size);
  plain::largest(direction, direction_size);
  plain::largest(x, x_size);
  Single rounded, next;
  plain::convert(x_size, rounded);
  plain::next_above(rounded, next);
  plain::convert(rounded, from);
  plain::convert(next, to);
  const Real error = 0x1p-51 * (origin_size + walked_size) + (high - low) * direction_size;
  Real step;
  plain::larger(to - from, error, step);

  // Candidate 0, on its side of the plane. The side wanted is that of the normal or behind it.
  Real longest, largest_term, magnitudes[3];
  plain::largest(normal, longest);
  plain::largest(size, largest_term);
  for (int k = 0; k < 3; ++k) magnitude(normal[k], magnitudes[k]);
  sure &= 8.0 * kU * largest_term <= 0x1p-34 * (magnitudes[0] + magnitudes[1] + magnitudes[2]);
  const Real along = plane > 0.0 ? way : -way;  // 1: to where the normal points
  const Real scale = 1.0 / longest;
  Real candidate[3], from_candidate[3], side, side_error;
  for (int k = 0; k < 3; ++k) plain::convert(x[k] + step * (normal[k] * (along * scale)), point[k]);
  plain::convert(point, candidate);
  plain::subtract(corner[0], candidate, from_candidate);
  plain::dot(from_candidate, normal, size, side, side_error);
  sure &= -along * side > side_error;

  // The least weight of X, times m . N.
  Real unit[3], from_corner[3];
  for (int k = 0; k < 3; ++k) unit[k] = normal[k] * scale;
  plain::subtract(x, corner[0], from_corner);
  Single b[3], c[3], p[3], m[3], whole, second, third, least, length, other_length, turn;
  plain::convert(to_b, b);
  plain::convert(to_c, c);
  plain::convert(from_corner, p);
  plain::convert(unit, m);
  plain::convert(unit[0] * normal[0] + unit[1] * normal[1] + unit[2] * normal[2], whole);
  plain::triple(m, p, c, second);
  plain::triple(m, b, p, third);
  least = whole - second - third;
  least = second < least ? second : least;
  least = third < least ? third : least;
  plain::largest(b, length);
  plain::largest(c, other_length);
  plain::larger(length, other_length, length);
  plain::convert(16.0 * step, reach);
  plain::convert(along, turn);
  const Single clearance = turn < 0.0f ? hits.clearance[0] : hits.clearance[1];
  clear = clearance * least > (reach + 0x1p-16f * length + margin) * whole;
}

}  // namespace raygate
