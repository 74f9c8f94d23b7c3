// sRGB (IEC 61966-2-1): conversion between scene-linear light and 8-bit codes.
#pragma once

#include <cstdint>

namespace raygate {

/// The sRGB code 0..255 nearest to scene-linear `linear`; below 0 and NaN give 0, above 1 gives
/// 255. Monotone, and the inverse of `srgb_to_linear` on all 256 codes.
[[nodiscard]] std::uint8_t linear_to_srgb(float linear);

/// The continuous curve that those codes are steps of: from light clamped to [0, 1] to [0, 1].
[[nodiscard]] double srgb_curve(double linear);
/// The same curve for any light from 0 on, more than 1 for more than white.
[[nodiscard]] double srgb_curve_above(double linear);

/// The scene-linear value of sRGB code `code` (a whole number 0..255, or between two of them).
[[nodiscard]] double srgb_to_linear(double code);

}  // namespace raygate
