// Proven bounds of the errors of t and P, by the angle between ray and plane.
#pragma once

namespace raygate::lab {

/// Return the largest relative errors of the unit's t = d / (I . N) and P_k = (d I_k) / (I . N) in
/// a sure hit whose exact values are normal floats. `sine` is that of the angle between ray and
/// plane. About (2 + 4 / sine) 2^-24 and (3 + 4 / sine) 2^-24; infinite if no bound is proven. See
/// errors.cpp for the proof.
[[nodiscard]] double bound_of_t(double sine);
[[nodiscard]] double bound_of_point(double sine);

/// Largest error in ulps of the hits that the host delivers, which are computed from the corners
/// (precise_hit in host/exact/exact.h), at any angle.
inline constexpr double kDeliveredUlp = 0.5 + 0x1p-10;

}  // namespace raygate::lab
