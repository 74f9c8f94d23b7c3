#include "host/film/compare.h"

#include <algorithm>
#include <cmath>

#include "host/base/input_error.h"
#include "host/base/srgb.h"

namespace raygate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PixelRect common_window(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Where pixel (x, y) of the frame is in the picture's arrays.
std::size_t place(const ChannelPicture& picture, int x, int y) {
  return static_cast<std::size_t>(y - picture.window.y0) *
             static_cast<std::size_t>(picture.window.width()) +
         static_cast<std::size_t>(x - picture.window.x0);
}

bool equal(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The light that a display shows, as it is perceived: the sRGB code of the luminance, in [0, 1].
std::vector<double> seen(const ChannelPicture& picture, const PixelRect& window) {
  std::vector<double> values;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t i = place(picture, x, y);
      const double light = 0.2126 * picture.channels[0][i] + 0.7152 * picture.channels[1][i] +
                           0.0722 * picture.channels[2][i];
      values.push_back(srgb_curve(std::isnan(light) ? 0.0 : light));
    }
  }
  return values;
}

bool shows_colors(const ChannelPicture& picture) {
  return picture.names == std::vector<std::string>{"R", "G", "B"};
}

std::string size_of(const ChannelPicture& picture) {
  return std::to_string(picture.width) + "x" + std::to_string(picture.height);
}

}  // namespace

Comparison compare(const ChannelPicture& picture, const ChannelPicture& reference) {
  if (picture.width != reference.width || picture.height != reference.height) {
    throw InputError("the pictures differ in size: " + size_of(picture) + " and " +
                     size_of(reference));
  }
  Comparison result;
  const PixelRect& window = result.window = common_window(picture.window, reference.window);
  if (window.width() <= 0 || window.height() <= 0) {
    throw InputError("the pictures have no pixel in common: their data windows do not overlap");
  }
  double squares = 0.0, absolutes = 0.0, relatives = 0.0, sum = 0.0, references = 0.0;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const std::size_t i = place(picture, x, y), j = place(reference, x, y);
      double largest = 0.0;
      bool differs = false;
      for (std::size_t c = 0; c < picture.channels.size(); ++c) {
        const double a = picture.channels[c][i], b = reference.channels[c][j];
        if (std::isfinite(b)) references += b;
        if (equal(a, b)) continue;
        differs = true;
        const double d = a - b;
        if (!std::isfinite(d)) {
          largest = kInfinity;
          continue;
        }
        largest = std::max(largest, std::abs(d));
        squares += d * d;
        absolutes += std::abs(d);
        sum += d;
        relatives += d * d / (b * b + 0.01);
      }
      ++result.pixels;
      result.differing += differs;
      result.not_finite += std::isinf(largest);
      result.max = std::max(result.max, largest);
      result.difference.push_back(largest);
    }
  }
  const double n = static_cast<double>(result.pixels * picture.channels.size());
  const bool comparable = result.not_finite == 0;
  result.mse = comparable ? squares / n : kInfinity;
  result.mae = comparable ? absolutes / n : kInfinity;
  if (sum != 0.0) result.bias = sum / references;
  if (!comparable) result.bias = kInfinity;
  result.relative_mse = comparable ? relatives / n : kInfinity;
  result.rmse = std::sqrt(result.mse);
  result.psnr = -10.0 * std::log10(result.mse);
  if (shows_colors(picture) && shows_colors(reference)) {
    result.ssim = ssim(seen(picture, window), seen(reference, window),
                       static_cast<std::size_t>(window.width()));
  }
  return result;
}

}  // namespace raygate
