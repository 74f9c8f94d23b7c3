// Sines, logarithms and powers. The results have the same bits on every machine, because they use
// only IEEE 754 additions, multiplications and divisions in a fixed order, not the C library.
// Also the sRGB curve (IEC 61966-2-1), which converts between scene-linear light and 8-bit codes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host/base/triple.h"

namespace raygate {

template <class D>
struct SineCosine {
  D sine, cosine;
};

/// Returns sine and cosine of an angle in turns (1 is 360 degrees), |turns| < 1000, with an error
/// below 2^-52. D is double or DoubleLanes.
template <class D>
RAYGATE_INLINE SineCosine<D> sine_cosine(const D& turns) {
  constexpr double kRadians = 6.283185307179586476925286766559;
  // The nearest quarter turn is found in float. The remainder is up to slightly over 1/8 turn.
  const auto quarter = whole(narrow(turns) * 4.0f + 4096.5f) - 4096;
  const D x = (turns - wide(quarter) * 0.25) * kRadians, y = x * x;
  // Taylor series; the first omitted term is below 2^-54.
  D sine = D{} + 1.0, cosine = D{} + 1.0;
  for (int k = 16; k >= 2; k -= 2) {
    sine = 1.0 - sine * (y * (1.0 / (k * (k + 1))));
    cosine = 1.0 - cosine * (y * (1.0 / (k * (k - 1))));
  }
  sine = sine * x;
  const auto is_odd = (quarter & 1) != 0;
  const D sine_sign = wide(1 - (quarter & 2)), cosine_sign = wide(1 - ((quarter + 1) & 2));
  return {choose(is_odd, cosine, sine) * sine_sign, choose(is_odd, sine, cosine) * cosine_sign};
}

/// Returns the angle of the point (x, y) in turns, counter-clockwise from +x, from -1/2 to 1/2,
/// with an error below 2^-50; 0 for (0, 0). T is float or FloatLanes, finite.
template <class T>
RAYGATE_INLINE WideOf<T> turns_of(const T& y, const T& x) {
  using D = WideOf<T>;
  constexpr double kTurnsOfRadian = 0.15915494309189533576888376337251;
  constexpr float kHalf = 0.41421356f;  // the tangent of 1/16 turn
  const T across = absolute(x), along = absolute(y);
  const auto is_steep = along > across;
  const T larger = choose(is_steep, along, across), smaller = choose(is_steep, across, along);
  const D ratio = wide(smaller) / wide(choose(larger > 0.0f, larger, spread<T>(1.0f)));
  const auto is_large = narrow(ratio) > kHalf;
  const D t = choose(is_large, (ratio - 1.0) / (ratio + 1.0), ratio), squared = t * t;
  D sum = D{} + 1.0 / 41;  // Taylor's series
  for (int k = 39; k >= 1; k -= 2) sum = 1.0 / k - sum * squared;
  D angle = t * sum * kTurnsOfRadian + choose(is_large, D{} + 0.125, D{});
  angle = choose(is_steep, 0.25 - angle, angle);
  angle = choose(x < 0.0f, 0.5 - angle, angle);
  return choose(y < 0.0f, -angle, angle);
}

/// Returns the base-2 logarithm of x, a positive number in the range of normal floats. The error is
/// below 2^-52 or a relative 2^-50, whichever is larger.
template <class D>
RAYGATE_INLINE D binary_logarithm(const D& x) {
  constexpr double kLog2OfE = 1.4426950408889634073599246810019;
  // x = m 2^exponent with m in about [sqrt(1/2), sqrt(2)]. The exponent is found in float.
  constexpr std::int32_t kRootOfHalf = 0x3F3504F3;
  const auto exponent = (bits_in(narrow(x)) - kRootOfHalf) >> 23;
  const D m = x * wide(float_of((127 - exponent) << 23));
  // ln m = 2 artanh s for s = (m - 1) / (m + 1), |s| < 0.172, by the Taylor series of artanh.
  const D s = (m - 1.0) / (m + 1.0), y = s * s;
  D sum = D{} + 1.0 / 23;
  for (int k = 21; k >= 1; k -= 2) sum = sum * y + 1.0 / k;
  return sum * s * (2.0 * kLog2OfE) + wide(exponent);
}

/// Returns 2^x for x < 128, with a relative error below 2^-50; 0 for x below -126.
template <class D>
RAYGATE_INLINE D binary_power(const D& x) {
  constexpr double kLogOf2 = 0.69314718055994530941723212145818;
  const auto rough = narrow(x);
  const auto is_zero = rough < -126.0f;
  const auto exponent = whole(at_least(rough, -126.0f) + 200.5f) - 200;
  const D y = (x - wide(exponent)) * kLogOf2;
  D sum = D{} + 1.0;
  for (int k = 14; k >= 1; --k) sum = sum * (y * (1.0 / k)) + 1.0;  // Taylor's series
  return choose(is_zero, D{}, sum * wide(float_of((exponent + 127) << 23)));
}

/// Returns base^exponent for a positive base in the range of normal floats, for results < 2^128.
template <class D>
RAYGATE_INLINE D power(const D& base, const D& exponent) {
  return binary_power<D>(binary_logarithm(base) * exponent);
}

/// Returns the scene-linear value of an sRGB code from 0 to 255, which may be fractional.
[[nodiscard]] inline double srgb_to_linear(double code) {
  const double value = code / 255.0;
  return value <= 0.04045 ? value / 12.92 : power((value + 0.055) / 1.055, 2.4);
}

/// Returns the sRGB value, not rounded or clamped, of a linear value >= 0; 1 is white in both.
[[nodiscard]] inline double srgb_curve_above(double linear) {
  const double x = linear;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * power(x, 1.0 / 2.4) - 0.055;
}

/// Returns the sRGB code from 0 to 255 nearest to a scene-linear value: 0 below 0 and for NaN, 255
/// above 1. The function is monotonic and inverts `srgb_to_linear` for all 256 codes.
[[nodiscard]] inline std::uint8_t linear_to_srgb(float linear) {
  // Entry k is the least linear value whose nearest code is k + 1.
  static const auto thresholds = [] {
    std::array<double, 255> thresholds{};
    for (std::size_t k = 0; k < thresholds.size(); ++k) {
      thresholds[k] = srgb_to_linear(static_cast<double>(k) + 0.5);
    }
    return thresholds;
  }();
  if (std::isnan(linear)) return 0;
  return static_cast<std::uint8_t>(
      std::ranges::upper_bound(thresholds, static_cast<double>(linear)) - thresholds.begin());
}

}  // namespace raygate
