// Polygon record: the 64 bytes that a hit test reads, which describe a triangle seen from an
// origin. Also the error bound of the hit point P that the hardware computes from a record.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "host/base/triple.h"
#include "host/exact/exact.h"

namespace raygate {

/// The 16 words of a triangle A, B, C seen from an origin O (A, B, C are the vertices minus O). All
/// rays from O share the record.
///
/// Words are results of double or exact arithmetic, rounded once to float. (N, d), and each edge
/// with its bound, are scaled by a power of two if their exponents are outside [-60, 60]. Scaling
/// changes neither hit points nor signs. All words are finite, except that a bound can be
/// +infinity: its edge is then always in doubt.
struct alignas(64) PolygonRecord {
  glm::vec3 normal{0.0f};            ///< words 0-2: N = (B-A) x (C-A), the paper's H
  float d = 0.0f;                    ///< word 3: N . A; its sign (-1, 0 or 1) is exact
  std::array<glm::vec3, 3> edges{};  ///< words 4-12: A x B, B x C, C x A; for a shared edge the
                                     ///< two triangles hold exactly negated words
  std::array<float, 3> bounds{};     ///< words 13-15: |float32(I . E) - exact| < bound for edge E,
                                     ///< for every direction I with components of magnitude under 2
};
static_assert(sizeof(PolygonRecord) == 64);

/// Returns e: 2^e scales the largest component of `v` into [1, 2); 0 if `v` is 0 or not finite.
template <class T>
[[nodiscard]] int to_unit(const glm::vec<3, T>& v) {
  const T size = largest(v);
  return size > T(0) && std::isfinite(size) ? -std::ilogb(size) : 0;
}

/// Returns v 2^exponent.
template <class T>
[[nodiscard]] glm::vec<3, T> scaled_by(const glm::vec<3, T>& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

/// The bound of an edge (x, y, z) is kEdgeBound 2^-24 (|x| + |y| + |z|), see polygon_record.cpp.
inline constexpr double kEdgeBound = 8.0 + 0x1p-7;

/// Returns the record of a triangle for rays from `origin`. All coordinates are finite with a
/// magnitude of at most 2^126. If the origin is in the triangle's plane, or the triangle has no
/// area, d is 0 and no ray hits it.
[[nodiscard]] PolygonRecord make_record(const glm::dvec3& origin, const Corners& triangle);

/// Returns words 0-3 (the plane) of make_record's result; the other words are 0.
[[nodiscard]] PolygonRecord make_plane(const glm::dvec3& origin, const Corners& triangle);

/// Sets records[i] to make_record(origin, triangles[i]), bit for bit. The spans have the same size.
void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records);

/// Triangles and the origins from which they are seen.
struct PlaneViews {
  glm::vec3 origins[kQuad];
  Corners triangles[kQuad];
};

/// Sets words[k][i] to word k of make_plane(views.origins[i], views.triangles[i]), bit for bit.
void make_planes(const PlaneViews& views, float (&words)[4][kQuad]);

// Derivation of the error bound of the hit point P = d I / V, for V = I . N and the direction I
//
// Let u = 2^-24, the unit roundoff; g: how far V's exponent is below the largest in N, or 0.
// 1. V has a relative error of at most r = 48.5 u 2^g (proof in hit_test_pkg.sv).
// 2. t = d / V: d adds 2 u, and the division u. In all, at most (48.5 * 2^g + 3.2) u / (1 - r).
// 3. P_k = (d I_k) / V has one more rounding: at most (48.5 * 2^g + 4.3) u / (1 - r), which is less
//    than 2^(6 + g) u = 2^(g - 18) while r <= 0.1, that is, up to g = 12.
// 4. If d I_k underflows, its error of 2^-150 is less than 2^-48 d for d >= 2^-102. So P_k changes
//    by less than 2^-48 t.
// 5. If P_k underflows, its error of 2^-150 is less than 2^-47 t for t >= 2^-103.
// The errors of 4 and 5 add up to less than 2^-46 t, which is at most 2^-46 of P's largest
// coordinate. Nothing overflows if d, t < 2^104.

/// Returns BurstResult::t_error: how far the exponent of V = I . N is below `largest`, the largest
/// exponent field of N, or 0. `v`: the bits of a finite V. `Bits`: std::int32_t or a vector.
template <class Bits>
RAYGATE_INLINE Bits grazing_of(const Bits& largest, const Bits& v) {
  return maximum(Bits(largest - (v >> 23 & 0xFF)), Bits{});
}

/// Returns the largest exponent field of a normal's words.
[[nodiscard]] inline std::int32_t largest_field(const glm::vec3& n) {
  const auto field = [](float x) { return std::bit_cast<std::int32_t>(x) >> 23 & 0xFF; };
  return std::max({field(n.x), field(n.y), field(n.z)});
}

/// Returns the bits of NearestHit::point_error: 2^(grazing - 18), or +infinity if d or V = I . N is
/// out of the range derived above. `d` and `v` have the bits of d and V.
template <class Bits>
RAYGATE_INLINE Bits point_error_of(const Bits& d, const Bits& v, const Bits& grazing) {
  constexpr std::int32_t kBias = 127, kMaxGrazing = 12, kRange = 102;
  const Bits d_field = d >> 23 & 0xFF, v_field = v >> 23 & 0xFF, apart = d_field - v_field;
  const Bits in_range = (d_field >= kBias - kRange) & (d_field <= kBias + kRange) & (v_field > 0) &
                        (v_field < 0xFF) & ((v ^ d) >= 0) & (grazing <= kMaxGrazing) &
                        (apart <= kRange) & (apart >= -kRange);
  return in_range ? (grazing + (kBias - 18)) << 23 : Bits{} + 0x7F800000;
}

}  // namespace raygate
