// sRGB (IEC 61966-2-1): conversion between scene-linear light and 8-bit codes.
#pragma once

#include <cstdint>

namespace raygate {

/// Returns the sRGB code from 0 to 255 nearest to scene-linear `linear`: 0 below 0 and for NaN, 255
/// above 1. Monotonic, and the inverse of `srgb_to_linear` for all 256 codes.
[[nodiscard]] std::uint8_t linear_to_srgb(float linear);

/// Returns the continuous sRGB curve of light clamped to [0, 1], in [0, 1].
[[nodiscard]] double srgb_curve(double linear);
/// Returns the sRGB curve of light from 0 on; above 1 for light above white.
[[nodiscard]] double srgb_curve_above(double linear);

/// Returns the scene-linear value of an sRGB code from 0 to 255, which may be fractional.
[[nodiscard]] double srgb_to_linear(double code);

}  // namespace raygate
