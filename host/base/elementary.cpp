#include "host/base/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace raygate {

double srgb_to_linear(double code) {
  const double value = code / 255.0;
  return value <= 0.04045 ? value / 12.92 : power((value + 0.055) / 1.055, 2.4);
}

double srgb_curve_above(double linear) {
  const double x = linear;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * power(x, 1.0 / 2.4) - 0.055;
}

std::uint8_t linear_to_srgb(float linear) {
  // Entry k is the least linear value whose nearest code is k + 1.
  static const auto thresholds = [] {
    std::array<double, 255> thresholds{};
    for (std::size_t k = 0; k < thresholds.size(); ++k) {
      thresholds[k] = srgb_to_linear(static_cast<double>(k) + 0.5);
    }
    return thresholds;
  }();
  if (std::isnan(linear)) return 0;
  // The code is the number of thresholds at or below the value.
  const auto above =
      std::upper_bound(thresholds.begin(), thresholds.end(), static_cast<double>(linear));
  return static_cast<std::uint8_t>(above - thresholds.begin());
}

}  // namespace raygate
