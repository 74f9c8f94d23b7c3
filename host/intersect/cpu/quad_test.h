// Quad test: one ray against up to four triangles, in float32 with error bounds.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "host/base/triple.h"
#include "host/exact/exact.h"

namespace raygate {

// Why a sure result is correct
//
// Let O be the ray's origin, I its direction, and z the axis of I's largest component, so that
// |s_x|, |s_y| <= 1 for s_x = I_x / I_z and s_y = I_y / I_z. Woop, Benthin and Wald ("Watertight
// ray/triangle intersection", 2013) shear a corner p to the point
//   (x, y) = ((p-O)_x - s_x (p-O)_z, (p-O)_y - s_y (p-O)_z).
// The ray becomes the origin of the sheared plane. It passes the edge from corner i to corner j on
// the side given by the sign of x_i y_j - y_i x_j (edge_side's product times a common factor). Two
// edges of opposite signs are a miss. If all have one sign, the ray's line goes through the
// triangle's interior: a hit if the crossing is in front of O, a miss if it is behind.
//
// Steps 1 to 4 bound the error of x_i y_j - y_i x_j, computed in float32. Let u = 2^-24, the unit
// roundoff; X, Y, Z the computed x, y, (p-O)_z; m at least the computed |p-O| of all corners on all
// axes; and S the sum of the six |X_i|, |Y_i|.
//
// 1. Error of X_i (Y_i likewise): (p-O)_x has one relative error of u, s_x Z has three, and their
//    difference one more. Underflow adds up to 2^-149 (1 + m). (p-O)_x and s_x Z are at most m, and
//    |X_i| <= 2.0001 m: |X_i - x_i| < (1 + 3 + 2.001) u m + 2^-149 (1 + m) < 6.01 u m = e.
// 2. Effect on the result: X_i Y_j - x_i y_j = X_i (Y_j - y_j) + y_j (X_i - x_i), so both products
//    together change by less than e (|X_i| + |Y_j| + |Y_i| + |X_j|) + 2 e^2, which is at most
//    6.01 u m S + 72.3 u^2 m^2.
// 3. Roundings of two products and their difference: 2.001 u (|X_i Y_j| + |Y_i X_j|) + 2^-149.
//    This is less than 2.01 u m S + 2^-149, because factors are at most 2.0001 m.
// 4. If 2^-20 <= m <= 2^40, nothing overflows, the 2^-149 (1 + m) of step 1 is less than 2^-60 u m,
//    and the 2^-149 of step 3 less than 2^-60 u^2 m^2. Otherwise nothing is sure.
//
// Sum: less than 8.02 u m S + 72.4 u^2 m^2. The code computes the bound b = m (8.5 u S + 2^-41 m),
// where 2^-41 = 128 u^2. Rounding changes b by less than 12 u b. The code computes m as the largest
// |Z_i| plus S. This may be too small by 4 u m: |(p-O)_x| exceeds |X_i| + |Z_i| at most by the
// errors of step 1. The margin of b covers the 4 u m.
//
// Position on the z axis
//
// Steps 5 and 6 bound the error of z*, the position of the hit relative to O along z. Let U_i be
// the three computed differences, numbered by the corner opposite the edge, and let all U_i > b
// (all U_i < -b is symmetric). The exact differences w_i are within b of U_i. Then
// z* = (sum w_i z_i) / (sum w_i) for the corners' z_i = (p-O)_z. Let D* = sum w_i, D' = sum U_i, D
// the computed D', and R the computed range of the corners' z, the largest minus the least.
//
// 5. The code uses weights U_i / D' instead of w_i / D*. The error of a weight is at most
//    |U_i (D* - D') + D' (U_i - w_i)| / (D' D*) <= (3 b U_i / D' + b) / D*, so three have 6 b / D*.
//    Both sets of weights sum to 1, and D* > D' - 3 b: the error of z* is below 6 b R / (D' - 3 b).
//    Each |U_i| is at most a product of two of the three |X_j| + |Y_j|: D' <= S^2 / 3 <= m S / 3.
//    D differs from D' by at most 2 u D' < 0.1 b, so D' - 3 b > D - 3.2 b.
//    R has an error of 2 u max |Z_i|. R's factor matters only if it is below 1, since z* is also
//    between the corners' z. So this error adds at most 2 u max |Z_i| to z*.
// 6. Each term has at most eight roundings: of Z_i, a product, two sums, two sums in D, a quotient,
//    and the sum with the bound. Weights are positive and sum to 1: less than 9 u max |Z_i| in all.
//    Underflow of a product adds 2^-150 / D' < 2^-70, because D' > 3 b > 2^-80. Three of these are
//    less than 2^-68 < 2^-45 m.
//
// So z* is within 6.5 b R / (D - 3.2 b) + 16 u max |Z_i| + 2^-45 m of the computed quotient,
// including the rounding of this bound, and within 16 u max |Z_i| of the range of the corners' z.
//
// The code uses O-p instead of p-O, so that the instruction that subtracts a corner also loads it.
// All magnitudes in steps 1 to 4 are the same.
//
// Rounded corners and rays
//
// Let binary64 corners, origin and direction be rounded to float. Let M be the largest coordinate
// of the corners, F that of the origin (each 0 if exact), and r = u (M + F), which exceeds the
// additional error of p-O. A rounded direction adds a relative error of 2 u to s_x and s_y.
//
// 1. e grows to 8.02 u m + 2.001 r <= 8.02 u w, for w = m + (M + F) / 4. If the direction is exact,
//    e = 6.01 u m + 2.001 r <= 6.01 u w, for w = m + (M + F) / 3: the bound above with w as m.
// 2. The error is less than e S + 2 e^2 <= 8.02 u w S + 128.7 u^2 w^2. With step 3, it is less than
//    10.03 u w S + 128.8 u^2 w^2. The computed bound is b = w (10.6 u S + 2^-40 w).
// 6. Each z has another error of r, and R one of 2 r, so 3.2 r is added to 16 u max |Z_i|.

/// A ray prepared for tests against many quads of triangles.
struct ShearedRay {
  std::int32_t axes[3];  ///< x, y, z of the shear; the ray goes farthest along the last one
  float origin[3];       ///< origin along these axes
  float shear[2];        ///< s_x, s_y
  float way;             ///< direction component along the z axis of the shear

  ShearedRay() = default;
  /// The direction must be usable (see is_usable).
  RAYGATE_INLINE explicit ShearedRay(const Ray& ray);

  /// Returns the sign bit of (O-p)_z for the ray's origin O and points p in front of it.
  [[nodiscard]] RAYGATE_INLINE std::int32_t sign_ahead() const {
    return std::bit_cast<std::int32_t>(-way) & std::numeric_limits<std::int32_t>::min();
  }
};

/// Computes the words of ShearedRays, one per lane, from origins and directions by axis.
template <class Floats>
RAYGATE_INLINE void shear(const Floats (&o)[3], const Floats (&d)[3],
                          Floats (&words)[sizeof(ShearedRay) / sizeof(float)]) {
  Floats size[3];
  for (int k = 0; k < 3; ++k) size[k] = absolute(d[k]);
  const IntOf<Floats> z_is_z = (size[2] >= size[0]) & (size[2] >= size[1]),
                      z_is_y = size[1] >= size[0];
  const auto pick = [&](const auto& z, const auto& y, const auto& x)
      __attribute__((always_inline)) {
    return z_is_z ? z : (z_is_y ? y : x);
  };
  constexpr IntOf<Floats> kAxis[3] = {IntOf<Floats>{}, IntOf<Floats>{} + 1, IntOf<Floats>{} + 2};
  Floats way[3];
  for (int k = 0; k < 3; ++k) {
    const int of_y = (k + 2) % 3, of_x = (k + 1) % 3;
    words[k] = float_of(pick(kAxis[k], kAxis[of_y], kAxis[of_x]));
    words[3 + k] = pick(o[k], o[of_y], o[of_x]);
    way[k] = pick(d[k], d[of_y], d[of_x]);
  }
  words[6] = way[0] / way[2];
  words[7] = way[1] / way[2];
  words[8] = way[2];
}

RAYGATE_INLINE ShearedRay::ShearedRay(const Ray& ray) {
  FloatQuad o[3], d[3], words[sizeof(ShearedRay) / sizeof(float)];
  for (int k = 0; k < 3; ++k) {
    o[k] = ray.origin[k] - FloatQuad{};
    d[k] = ray.direction[k] - FloatQuad{};
  }
  raygate::shear(o, d, words);
  float first[sizeof(ShearedRay) / sizeof(float)];
  for (std::size_t i = 0; i < std::size(first); ++i) first[i] = words[i][0];
  std::memcpy(this, first, sizeof first);
}

/// The parts of a test that are rounded to binary32.
struct RoundedParts {
  bool corners = false, direction = false;
  float reach = 0.0f;  ///< largest coordinate of the origin (F above), or 0 if the origin is exact

  RoundedParts() = default;
  RoundedParts(bool of_corners, const ExactRay& ray)
      : corners(of_corners),
        direction(!is_binary32(ray.direction)),
        reach(is_binary32(ray.origin) ? 0.0f : static_cast<float>(largest(ray.origin))) {}
};

/// Results of a quad test. Bit i of the masks, and lane i, belong to triangle i.
struct QuadVerdict {
  LaneMask hit;    ///< sure hits, in front of the origin
  LaneMask level;  ///< the ray's line surely hits, perhaps behind the origin; is_ahead decides
  LaneMask doubt;  ///< neither hit, nor level, nor a sure miss
  /// Bounds of a hit's position along the ray's longest axis, for triangles in any of the masks.
  FloatQuad low, high;
};

/// Intermediate results, from find_sides() to judge_sides().
struct QuadSides {
  FloatQuad z[3];             ///< z of origin minus corner
  FloatQuad across[3];        ///< U_i above, by corner
  FloatQuad lowest, highest;  ///< least and largest of `across`
  FloatQuad farthest, m;      ///< max |Z_i| and m (or w) above
  FloatQuad rest;             ///< 3.2 r above; set only if something is rounded
  FloatQuad bound;            ///< b above; NaN if nothing is sure: comparisons with NaN are false
};

/// Returns a mask of the 1 to 4 triangles that the ray may hit; by their edges, all others are sure
/// misses. Coordinate k of corner v of triangle i is corners[(3 v + k) count + i]; memory up to
/// corners[8 count + 3] must be readable. If no part is rounded, kIsRounded has no effect.
template <bool kIsRounded = false>
[[nodiscard]] RAYGATE_INLINE LaneMask find_sides(const ShearedRay& ray, const float* corners,
                                                 std::uint32_t count, QuadSides& sides,
                                                 const RoundedParts& rounding = {}) {
  const bool is_wide = kIsRounded && rounding.direction;
  const float bound_of_sum = (is_wide ? 10.6f : 8.5f) * 0x1p-24f;
  const float bound_of_size = is_wide ? 0x1p-40f : 0x1p-41f;
  constexpr float kSmallest = 0x1p-20f, kLargest = 0x1p40f;
  const std::ptrdiff_t stride = count;
  const float* const along[3] = {corners + stride * ray.axes[0], corners + stride * ray.axes[1],
                                 corners + stride * ray.axes[2]};
  FloatQuad x[3], y[3], (&z)[3] = sides.z, size[3], most = {};
  for (std::ptrdiff_t v = 0; v < 3; ++v) {
    x[v] = load<FloatQuad>(along[0] + 3 * v * stride);
    y[v] = load<FloatQuad>(along[1] + 3 * v * stride);
    z[v] = load<FloatQuad>(along[2] + 3 * v * stride);
    if (kIsRounded && rounding.corners) {
      for (const FloatQuad& axis : {x[v], y[v], z[v]}) most = maximum(most, absolute(axis));
    }
    z[v] = ray.origin[2] - z[v];
    x[v] = (ray.origin[0] - x[v]) - ray.shear[0] * z[v];
    y[v] = (ray.origin[1] - y[v]) - ray.shear[1] * z[v];
    size[v] = absolute(x[v]) + absolute(y[v]);
  }
  const FloatQuad sum = (size[0] + size[1]) + size[2];
  sides.farthest = maximum(maximum(absolute(z[0]), absolute(z[1])), absolute(z[2]));
  FloatQuad m = sides.farthest + sum;
  if constexpr (kIsRounded) {
    const FloatQuad far = most + rounding.reach;
    m += (is_wide ? 0.25f : 1.0f / 3.0f) * far;
    sides.rest = (3.2f * 0x1.01p-24f) * far;
  }
  sides.m = m;
  const IntQuad unsure = (m < kSmallest) | (m > kLargest);
  const FloatQuad bound = float_of(bits_in(m * (bound_of_sum * sum + bound_of_size * m)) | unsure);
  const FloatQuad across[3] = {x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0],
                               x[0] * y[1] - y[0] * x[1]};
  std::copy_n(across, 3, sides.across);
  sides.lowest = minimum(minimum(across[0], across[1]), across[2]);
  sides.highest = maximum(maximum(across[0], across[1]), across[2]);
  sides.bound = bound;
  const IntQuad miss = (sides.lowest < -bound) & (sides.highest > bound);
  return ~sign_mask(miss) & ((1u << count) - 1);
}

/// Computes the verdicts on the triangles in `open` from the results of find_sides().
template <bool kIsRounded = false>
RAYGATE_INLINE void judge_sides(const ShearedRay& ray, const QuadSides& sides, LaneMask open,
                                QuadVerdict& verdict) {
  const auto& [of_z, across, lowest, highest, farthest, m, rest, bound] = sides;
  FloatQuad z[3];
  for (int v = 0; v < 3; ++v) z[v] = float_of(bits_in(of_z[v]) ^ ray.sign_ahead());
  FloatQuad near = minimum(minimum(z[0], z[1]), z[2]), far = maximum(maximum(z[0], z[1]), z[2]);
  const FloatQuad whole = (across[0] + across[1]) + across[2];
  const FloatQuad middle = ((across[0] * z[0] + across[1] * z[1]) + across[2] * z[2]) / whole;
  const FloatQuad sure_whole = absolute(whole) - 3.2f * bound;
  const IntQuad through = ((lowest > bound) | (highest < -bound)) & (sure_whole > 0.0f);
  FloatQuad rounding = (16.0f * 0x1p-24f) * farthest;
  if constexpr (kIsRounded) rounding += rest;
  const FloatQuad room = rounding + 0x1p-45f * m;
  const FloatQuad width = (6.5f * bound / sure_whole) * (far - near) + room;
  near -= rounding;
  far += rounding;
  const FloatQuad low = middle - width, high = middle + width;
  verdict.low = (through & (low > near)) ? low : near;
  verdict.high = (through & (high < far)) ? high : far;
  const LaneMask inside = open & sign_mask(through);
  verdict.hit = inside & sign_mask(verdict.low > 0.0f);
  verdict.level = inside & ~verdict.hit & ~sign_mask(verdict.high < 0.0f);
  verdict.doubt = open & ~inside;
}

/// Tests 1 to 4 triangles: find_sides(), then judge_sides().
template <bool kIsRounded = false>
RAYGATE_INLINE void test_quad(const ShearedRay& ray, const float* corners, std::uint32_t count,
                              QuadVerdict& verdict, const RoundedParts& rounding = {}) {
  QuadSides sides;
  const LaneMask open = find_sides<kIsRounded>(ray, corners, count, sides, rounding);
  judge_sides<kIsRounded>(ray, sides, open, verdict);
}

// Why a sure result is correct
//
// These steps bound the errors of I . E, I . N and d = A . N in float32. Let u = 2^-24, the unit
// roundoff; A, B, C the corners minus the ray's origin, with coordinates of at most m <= 2^40;
// E = A x (B-A) an edge plane (the other two follow cyclically); N = (B-A) x (C-B); L the sum of
// the magnitudes of the six products of E or N; and I a direction with |I_i| < 2.
//
// 1. Words of E: factors are differences with a relative error of u. So a product has a relative
//    error of 3 u, or an error of 2^-150 if it underflows. Their difference adds u. The errors of
//    E's words sum to at most 4 u L + 2^-147, and their magnitudes to at most L (1 + 4 u).
// 2. I . E: in float32, in any order, a word takes part in at most three roundings. These have an
//    error of 3.0001 u |I|.|E| + 2^-148. So |float32(I . E) - I . (A x B)| is less than
//    2 (4 + 3.001) u L + 2^-145 < 14.1 u L + 2^-145. The computed bound, 14.5 u L + 2^-100 for the
//    largest of three L, also covers its own relative rounding error, 7 u.
// 3. I . N has likewise an error of less than 14.5 u L + 2^-100. In A . N, factors are at most m,
//    not 2, and have another relative error of u: its error is less than
//    m (4 + 3.001 + 1.001) u L + 2^-105 < 8.5 u m L + 2^-100.
//
// For a hit, all three I . E have the sign of d = A . N (see exact.cpp), and t = d / (I . N). All
// words are stored multiplied by the sign of d, if float32 is sure of that sign.
//
// If the corners are rounded from binary64, let M be their largest coordinate, r = u M, and s the
// largest coordinate of a side. Then A, B, C have errors of r, and sides of 2 r.
//
// 1. A product of A and a side has an error of r |side| + 2 r |A| + 2 r^2. Six products have
//    2 r |side|_1 + 4 r |A|_1 + 12 r^2 <= 6 r s + 12 r m + 12 r^2. The error of I . E is at most
//    twice as large, so 26 r (m + s / 2 + r) is added to its bound.
// 2. |N|_1 has an error of 4 r (|B-A|_1 + |C-B|_1) + 24 r^2 <= 24 r (s + r). The error of I . N is
//    at most twice as large, so 50 r (s + r) is added to its bound.
// 3. The error of A . N is r |N|_1, for the exact N, plus m times the error of N:
//    1.1 r L + 26 (m + r) r (s + r) is added to its bound.

/// Four planes of each of four triangles: the planes of the edges, and N.
struct alignas(sizeof(FloatLanes)) QuadRecord {
  static constexpr int kNormal = 3;

  /// Words times the sign of d. Plane p is [p / 2][axis][p % 2]; word i belongs to triangle i.
  float planes[2][3][2][kQuad];
  float bounds[kQuad];            ///< |float32(I . E) - exact| < bound, for each edge E
  float normal_bound[kQuad];      ///< |float32(I . N) - exact| < bound
  float low[kQuad], high[kQuad];  ///< bounds of |d|; low = 0 if the sign of d was unsure
  std::int32_t flip[kQuad];       ///< the sign bit of d, as computed or set
  LaneMask unsure;                ///< triangles whose d may have the other sign

  [[nodiscard]] RAYGATE_INLINE float word(int plane, int axis, int triangle) const {
    return planes[plane / 2][axis][plane % 2][triangle];
  }
};

/// The bound of I . E or I . N is kQuadBound u L + 2^-100 (step 2 above).
inline constexpr float kQuadBound = 14.5f;

/// Computes the record of 1 to 4 triangles, with corners in the format of test_quad.
template <bool kIsRounded>
RAYGATE_INLINE void make_quad_record(const glm::vec3& origin, const float* corners,
                                     std::uint32_t count, QuadRecord& record) {
  constexpr float kU = 0x1p-24f, kTiny = 0x1p-100f, kLargest = 0x1p40f;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::ptrdiff_t stride = count;
  Triple<FloatQuad> p[3];
  FloatQuad coordinate = {}, side = {}, farthest = {};  // largest magnitudes
  for (std::ptrdiff_t v = 0; v < 3; ++v) {
    const float* const corner = corners + 3 * v * stride;
    p[v] = {load<FloatQuad>(corner), load<FloatQuad>(corner + stride),
            load<FloatQuad>(corner + 2 * stride)};
    if constexpr (kIsRounded) coordinate = maximum(largest_size(p[v]), coordinate);
  }
  const Triple<FloatQuad> sides[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  for (int v = 0; v < 3; ++v) {
    p[v] = p[v] - spread<FloatQuad>(origin);
    farthest = maximum(largest_size(p[v]), farthest);
    if constexpr (kIsRounded) side = maximum(largest_size(sides[v]), side);
  }
  const auto pair = [](const Triple<FloatQuad>& low, const Triple<FloatQuad>& high) RAYGATE_BODY {
    return Triple<FloatLanes>{join(low.x, high.x), join(low.y, high.y), join(low.z, high.z)};
  };
  // Pairs in one vector each: A x (B-A) and B x (C-B); then C x (A-C) and N = (B-A) x (C-B).
  Triple<FloatLanes> terms[2];
  const Triple<FloatLanes> planes[2] = {
      cross(pair(p[0], p[1]), pair(sides[0], sides[1]), terms[0]),
      cross(pair(p[2], sides[0]), pair(sides[2], sides[1]), terms[1])};
  const FloatLanes sizes[2] = {terms[0].x + terms[0].y + terms[0].z,
                               terms[1].x + terms[1].y + terms[1].z};
  const FloatQuad largest =
      maximum(low_half(sizes[1]), maximum(high_half(sizes[0]), low_half(sizes[0])));
  const FloatQuad size = high_half(sizes[1]);
  FloatQuad edge_bound = (kQuadBound * kU) * largest + kTiny,
            normal_bound = (kQuadBound * kU) * size + kTiny,
            distance_bound = (8.5f * kU) * farthest * size + kTiny;
  if constexpr (kIsRounded) {
    const FloatQuad r = 0x1.01p-24f * coordinate;
    edge_bound += 26.0f * r * (farthest + 0.5f * side + r);
    normal_bound += 50.0f * r * (side + r);
    distance_bound += 1.1f * r * size + 26.0f * (farthest + r) * r * (side + r);
  }
  const IntQuad small = farthest <= kLargest;
  const Triple<FloatQuad> normal = {high_half(planes[1].x), high_half(planes[1].y),
                                    high_half(planes[1].z)};
  const FloatQuad d = dot(p[0], normal);
  const FloatQuad d_bound = small ? distance_bound : FloatQuad{} + kInfinity;
  const FloatQuad distance = absolute(d);
  const IntQuad sure = distance > d_bound;
  const IntQuad flip = bits_in(d) & std::numeric_limits<std::int32_t>::min();
  const IntLanes flips = join(flip, flip);
  for (int i = 0; i < 2; ++i) {
    store(record.planes[i][0], bits_in(planes[i].x) ^ flips);
    store(record.planes[i][1], bits_in(planes[i].y) ^ flips);
    store(record.planes[i][2], bits_in(planes[i].z) ^ flips);
  }
  store(record.bounds, small ? edge_bound : FloatQuad{} + kInfinity);
  store(record.normal_bound, normal_bound);
  store(record.low, sure ? distance - d_bound : FloatQuad{});
  store(record.high, small ? distance + d_bound : FloatQuad{} + kInfinity);
  store(record.flip, flip);
  record.unsure = ~sign_mask(sure) & ((1u << count) - 1);
}

/// Sets the sign of a triangle's d to `side`, -1 or 1, if float32 is not sure of it.
RAYGATE_INLINE void set_side(QuadRecord& record, int triangle, int side) {
  if ((record.flip[triangle] != 0) == (side < 0)) return;
  record.flip[triangle] ^= std::numeric_limits<std::int32_t>::min();
  for (auto& pair : record.planes) {
    for (auto& axis : pair) {
      for (auto& plane : axis) plane[triangle] = -plane[triangle];
    }
  }
}

}  // namespace raygate
