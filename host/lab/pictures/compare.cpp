#include "host/lab/pictures/compare.h"

#include <array>
#include <cmath>

#include "host/base/elementary.h"

namespace raygate::lab {
namespace {

/// Returns the perceived brightness of displayed pixels: the sRGB code of the luminance, in [0, 1].
std::vector<double> seen(const Film& film) {
  std::vector<double> values;
  for (const glm::vec4& color : film.color) {
    const double light = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
    values.push_back(srgb_curve(std::isnan(light) ? 0.0 : light));
  }
  return values;
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

Comparison compare(const Film& picture, const Film& reference) {
  Comparison result;
  double squares = 0.0;
  for (std::size_t i = 0; i < picture.color.size(); ++i) {
    bool differs = false;
    for (int k = 0; k < 3; ++k) {
      const double d = double{picture.color[i][k]} - double{reference.color[i][k]};
      differs = differs || d != 0.0;
      squares += d * d;
    }
    result.differing += differs;
  }
  const double mse = squares / static_cast<double>(3 * picture.color.size());
  result.rmse = std::sqrt(mse);
  result.psnr = -10.0 * std::log10(mse);
  result.ssim =
      ssim(seen(picture), seen(reference), static_cast<std::size_t>(picture.window.width()));
  return result;
}

}  // namespace raygate::lab
