// How far off t and P may be at most, by the angle between ray and plane.
#pragma once

namespace raygate::lab {

/// The largest relative error that the unit's t = d / (I . N) may have in a sure hit, and its
/// P_k = (d I_k) / (I . N), the exact ones being normal floats; `sine` of the angle between ray
/// and plane. About (2 + 4 / sine) 2^-24 and (3 + 4 / sine) 2^-24; infinite where nothing is
/// proven. error_bounds.cpp has the proof.
[[nodiscard]] double bound_of_t(double sine);
[[nodiscard]] double bound_of_point(double sine);

/// The same as errors in ulp (the step of floats near the exact value).
[[nodiscard]] double in_ulp(double relative);

/// What the host delivers in the end, refined from the corners (precise_hit in host/exact/exact.h),
/// is off by no more than so many ulp, at any angle.
inline constexpr double kDeliveredUlp = 0.5 + 0x1p-10;

}  // namespace raygate::lab
