// Quad record: the edge and normal planes of up to four triangles seen from one origin, in float32.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "host/base/lanes.h"
#include "host/exact/exact.h"

// Why a sure answer is right
//
// As in polygon_record.cpp, but all of it in float32. Let u = 2^-24, A, B, C the corners minus O, E
// = A x (B-A) an edge plane, L the sum of the magnitudes of the six products that it is made of,
// and I a direction with |I_i| < 2. Coordinates of A, B and C are at most 2^40.
//
// 1. Factors are differences, off by u of themselves, so a product is off by 3 u of itself, or
//    2^-150 if it underflows, and their difference by u more: the words of E are off by (4 u L)_1
//    in all, and 2^-147, and their magnitudes sum to L (1 + 4 u) at most.
// 2. I . E in float32, in any order, rounds a word three times at most: it is off by 3.0001 u
//    |I|.|E|, and 2^-148. So |float32(I . E) - I . (A x B)| < 2 (4 + 3.001) u L + 2^-145 < 14.1 u L
//    + 2^-145. The bound computed, 14.5 u L + 2^-100 for the largest of three L, has room for its
//    own roundings, 7 u of it.
// 3. Likewise N = (B-A) x (C-B), with its own L: I . N is off by less than 14.5 u L + 2^-100. A . N
//    has three more factors that are u off themselves, of size m at most: it is off by less than m
//    (4 + 3.001 + 1.001) u L + 2^-105 < 8.5 u m L + 2^-100.
//
// A hit has all three I . E of the sign of d = A . N (exact.cpp says why), and t = d / (I . N). All
// words are stored with the sign of d, where float32 is sure of it.

namespace raygate {

/// Four planes of four triangles: three edges', and N.
struct alignas(sizeof(FloatLanes)) QuadRecord {
  static constexpr int kNormal = 3;

  /// Of d's sign: plane p is [p / 2][axis][p % 2], word i triangle i's.
  float planes[2][3][2][kQuad];
  float bounds[kQuad];            ///< |float32(I . E) - exact| < bound, for each of the edges
  float normal_bound[kQuad];      ///< likewise for I . N
  float low[kQuad], high[kQuad];  ///< |d| is between them; low = 0 where the sign was unsure
  std::int32_t flip[kQuad];       ///< the sign bit of d as computed
  LaneMask unsure;                ///< whose d may have another sign

  [[nodiscard]] RAYGATE_INLINE float word(int plane, int axis, int triangle) const {
    return planes[plane / 2][axis][plane % 2][triangle];
  }
};

/// A bound is kQuadBound u L, see above.
inline constexpr float kQuadBound = 14.5f;

/// The record of 1 to 4 triangles, their corners as test_quad takes them.
RAYGATE_INLINE void make_quad_record(const float (&origin)[3], const float* corners,
                                     std::uint32_t count, QuadRecord& record) {
  constexpr float kU = 0x1p-24f, kTiny = 0x1p-100f, kLargest = 0x1p40f;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::ptrdiff_t stride = count;
  FloatQuad p[3][3], sides[3][3], farthest = {};
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) p[v][k] = load<FloatQuad>(corners + stride * (3 * v + k));
  }
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) sides[v][k] = p[(v + 1) % 3][k] - p[v][k];
  }
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) {
      p[v][k] = p[v][k] - origin[k];
      farthest = maximum(absolute(p[v][k]), farthest);
    }
  }
  // A x (B-A) and B x (C-B) side by side; C x (A-C) and (B-A) x (C-B), which is N.
  FloatLanes u[3], v[3], planes[2][3], sizes[2];
  for (int k = 0; k < 3; ++k) {
    u[k] = join(p[0][k], p[1][k]);
    v[k] = join(sides[0][k], sides[1][k]);
  }
  const auto cross_of = [&](FloatLanes(&plane)[3], FloatLanes & sum)
      __attribute__((always_inline)) {
    FloatLanes size[3];
    cross(u, v, plane, size);
    sum = size[0] + size[1] + size[2];
  };
  cross_of(planes[0], sizes[0]);
  for (int k = 0; k < 3; ++k) {
    u[k] = join(p[2][k], sides[0][k]);
    v[k] = join(sides[2][k], sides[1][k]);
  }
  cross_of(planes[1], sizes[1]);
  FloatQuad largest = low_half(sizes[0]);
  largest = maximum(high_half(sizes[0]), largest);
  largest = maximum(low_half(sizes[1]), largest);
  const FloatQuad size = high_half(sizes[1]);
  const IntQuad small = farthest <= kLargest;
  const FloatQuad d = (p[0][0] * high_half(planes[1][0]) + p[0][1] * high_half(planes[1][1])) +
                      p[0][2] * high_half(planes[1][2]);
  const FloatQuad d_bound = small ? (8.5f * kU) * farthest * size + kTiny : FloatQuad{} + kInfinity;
  const FloatQuad distance = absolute(d);
  const IntQuad sure = distance > d_bound;
  const IntQuad flip = bits_in(d) & std::numeric_limits<std::int32_t>::min();
  const IntLanes flips = join(flip, flip);
  for (int pair = 0; pair < 2; ++pair) {
    for (int k = 0; k < 3; ++k) {
      store(record.planes[pair][k], bits_in(planes[pair][k]) ^ flips);
    }
  }
  store(record.bounds, small ? (kQuadBound * kU) * largest + kTiny : FloatQuad{} + kInfinity);
  store(record.normal_bound, (kQuadBound * kU) * size + kTiny);
  store(record.low, sure ? distance - d_bound : FloatQuad{});
  store(record.high, small ? distance + d_bound : FloatQuad{} + kInfinity);
  store(record.flip, flip);
  record.unsure = ~sign_mask(sure) & ((1u << count) - 1);
}

/// Says which sign d has, -1 or 1, where float32 is not sure.
RAYGATE_INLINE void set_side(QuadRecord& record, int triangle, int side) {
  if ((record.flip[triangle] != 0) == (side < 0)) return;
  for (auto& pair : record.planes) {
    for (auto& axis : pair) {
      for (auto& plane : axis) plane[triangle] = -plane[triangle];
    }
  }
}

}  // namespace raygate
