// Error bound of the hit-test unit's point P.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lanes.h"

// Derivation of the bound
//
// Let u = 2^-24 and g be how far V's exponent is below the largest of N's, or 0. By hit_test_pkg.sv
// the relative error of V is at most r = 48.5 u 2^g, and that of t, with 2 u of d and u of its
// division, at most (48.5 * 2^g + 3.2) u / (1 - r). A coordinate of P has one more rounding, of d
// I_k: (48.5 * 2^g + 4.3) u / (1 - r) of t I_k < 2^(6 + g) u = 2^(g - 18) while r <= 0.1, which
// holds up to g = 12. A product d I_k that underflows has an error of 2^-150, which is less than
// 2^-48 of d if d is at least 2^-102; nothing overflows if d, t < 2^104. So the error is 2^-48 t in
// P, and 2^-150 for a coordinate that underflows, less than 2^-47 t if t is at least 2^-103. These
// two are not small relative to a small coordinate: together they are less than 2^-46 of the
// largest.

namespace raygate {

/// Returns the grazing that the unit reports with a hit (BurstHit::t_error), from the largest
/// exponent field of N and the bits of V (finite). `Bits` is std::int32_t or a vector of it.
template <class Bits>
RAYGATE_INLINE Bits grazing_of(const Bits& largest, const Bits& v) {
  return maximum(Bits(largest - (v >> 23 & 0xFF)), Bits{});
}

/// Returns the largest exponent field of a normal's words.
[[nodiscard]] inline std::int32_t largest_field(const glm::vec3& n) {
  const auto field = [](float x) { return std::bit_cast<std::int32_t>(x) >> 23 & 0xFF; };
  return std::max({field(n.x), field(n.y), field(n.z)});
}

/// Returns the bits of NearestHit::point_error from those of d and V: 2^(grazing - 18), or
/// +infinity if V is not finite or too small for the unit.
template <class Bits>
RAYGATE_INLINE Bits point_error_of(const Bits& d, const Bits& v, const Bits& grazing) {
  constexpr std::int32_t kBias = 127, kMaxGrazing = 12, kRange = 102;
  const Bits d_field = d >> 23 & 0xFF, v_field = v >> 23 & 0xFF, apart = d_field - v_field;
  const Bits in_range = (d_field >= kBias - kRange) & (d_field <= kBias + kRange) & (v_field > 0) &
                        (v_field < 0xFF) & ((v ^ d) >= 0) & (grazing <= kMaxGrazing) &
                        (apart <= kRange) & (apart >= -kRange);
  return in_range ? (grazing + (kBias - 18)) << 23 : Bits{} + 0x7F800000;
}

/// Computes P of a plane (N, d) and a direction in each lane, and the bits of its error, as
/// plane_point does. `largest`: the largest exponent field of N.
template <class Floats, class Ints>
RAYGATE_INLINE void plane_points(const Floats (&n)[3], const Floats& d, const Ints& largest,
                                 const Floats (&direction)[3], Floats (&point)[3], Ints& error) {
  const Floats v = 0.0f + ((n[0] * direction[0] + n[1] * direction[1]) + n[2] * direction[2]);
  error = point_error_of(bits_in(d), bits_in(v), grazing_of(largest, bits_in(v)));
  for (int k = 0; k < 3; ++k) {
    const Floats p = d * direction[k] / v;
    point[k] = p == p ? p : float_of(Ints{} + 0x7FC00000);
  }
}

}  // namespace raygate
