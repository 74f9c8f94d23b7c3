#include "host/render/splat_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace raygate {

SplatLayer::SplatLayer(const PixelRect& window, ReconstructionFilter filter)
    : window_(window),
      filter_(filter),
      sums_(std::size_t(window.width()) * std::size_t(window.height())) {}

void SplatLayer::add(std::span<const Splat> splats) {
  const double radius = filter_radius(filter_);
  for (const Splat& splat : splats) {
    const glm::dvec2 low = splat.place - radius, high = splat.place + radius;
    // Positions may exceed the range of int.
    const auto pixel = [](double at, int first, int end) {
      return static_cast<int>(std::clamp<double>(at, first, end));
    };
    const int x0 = pixel(std::ceil(low.x - 0.5), window_.x0, window_.x1);
    const int x1 = pixel(std::floor(high.x - 0.5) + 1.0, window_.x0, window_.x1);
    const int y0 = pixel(std::ceil(low.y - 0.5), window_.y0, window_.y1);
    const int y1 = pixel(std::floor(high.y - 0.5) + 1.0, window_.y0, window_.y1);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const double weight = filter_density(filter_, splat.place - glm::dvec2(x + 0.5, y + 0.5));
        const std::size_t row = std::size_t(y - window_.y0) * std::size_t(window_.width());
        auto& sum = sums_[row + std::size_t(x - window_.x0)];
        for (int k = 0; k < 3; ++k) sum[k].add(weight * splat.light[k]);
      }
    }
  }
}

void SplatLayer::add_to(Film& film) const {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const std::uint32_t samples = film.sums.samples[i];
    for (std::size_t k = 0; k < 3; ++k) film.sums.color[i][k] += sums_[i][k];
    if (samples != 0) film.color[i] = mean_of(film.sums.color[i], samples);
  }
}

}  // namespace raygate
