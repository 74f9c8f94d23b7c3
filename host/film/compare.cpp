#include "host/film/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "host/base/input_error.h"
#include "host/base/srgb.h"
#include "host/scene/texture.h"

namespace raygate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PixelRect common_window(const PixelRect& a, const PixelRect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Returns the array index of pixel (x, y) of the frame.
std::size_t place(const ChannelPicture& picture, int x, int y) {
  return static_cast<std::size_t>(y - picture.window.y0) *
             static_cast<std::size_t>(picture.window.width()) +
         static_cast<std::size_t>(x - picture.window.x0);
}

bool equal(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Returns the perceived brightness of displayed pixels: the sRGB code of the luminance, in [0, 1].
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

constexpr std::size_t kSide = 11;

std::array<double, kSide> gaussian() {
  std::array<double, kSide> weights{};
  double sum = 0.0;
  for (std::size_t i = 0; i < kSide; ++i) {
    const double x = static_cast<double>(i) - (kSide - 1) / 2.0;
    sum += weights[i] = std::exp(-x * x / (2.0 * 1.5 * 1.5));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Returns Gaussian-weighted means of a(p) b(p) over all window positions: by rows, then columns.
template <typename Value>
std::vector<double> blurred(Value value, std::size_t width, std::size_t height) {
  static const std::array<double, kSide> kWeights = gaussian();
  const std::size_t columns = width - kSide + 1, rows = height - kSide + 1;
  std::vector<double> across(columns * height), means(columns * rows);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < columns; ++x) {
      for (std::size_t i = 0; i < kSide; ++i) {
        across[y * columns + x] += kWeights[i] * value(y * width + x + i);
      }
    }
  }
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t i = 0; i < kSide; ++i) {
      for (std::size_t x = 0; x < columns; ++x) {
        means[y * columns + x] += kWeights[i] * across[(y + i) * columns + x];
      }
    }
  }
  return means;
}

}  // namespace

std::optional<double> ssim(const std::vector<double>& a, const std::vector<double>& b,
                           std::size_t width) {
  const std::size_t height = width > 0 ? a.size() / width : 0;
  if (width < kSide || height < kSide) return std::nullopt;
  const auto blur = [&](auto value) { return blurred(value, width, height); };
  const auto mean_a = blur([&](std::size_t i) { return a[i]; });
  const auto mean_b = blur([&](std::size_t i) { return b[i]; });
  const auto mean_aa = blur([&](std::size_t i) { return a[i] * a[i]; });
  const auto mean_bb = blur([&](std::size_t i) { return b[i] * b[i]; });
  const auto mean_ab = blur([&](std::size_t i) { return a[i] * b[i]; });
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  double sum = 0.0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double products = mean_a[i] * mean_b[i];
    const double squares = mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i];
    const double covariance = mean_ab[i] - products;
    const double variances = mean_aa[i] + mean_bb[i] - squares;
    sum +=
        (2.0 * products + kC1) * (2.0 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
  }
  return sum / static_cast<double>(mean_a.size());
}

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

ChannelPicture read_picture(const std::filesystem::path& file, std::span<const std::string> names) {
  if (file.extension() != ".png" && file.extension() != ".PNG") return read_exr(file, names);
  const Texture texture = Texture::load(file);
  ChannelPicture picture;
  picture.width = texture.width();
  picture.height = texture.height();
  picture.window = {0, 0, picture.width, picture.height};
  constexpr std::string_view kColors[] = {"R", "G", "B"};
  for (const std::string& name : names) {
    const auto* const found = std::ranges::find(kColors, name);
    if (found == std::end(kColors)) {
      throw InputError(file.string() + ": has no channel " + name + ", a PNG has R, G and B");
    }
    const auto k = static_cast<std::size_t>(found - std::begin(kColors));
    picture.names.push_back(name);
    std::vector<double>& channel = picture.channels.emplace_back();
    channel.reserve(texture.texels().size());
    for (const Texture::Texel& codes : texture.texels()) {
      channel.push_back(srgb_to_linear(codes[k]));
    }
  }
  return picture;
}

}  // namespace raygate
