#include "host/render/splat_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace raygate {

SplatLayer::SplatLayer(const Film& film, ReconstructionFilter filter)
    : window_(film.window), filter_(filter), sums_(film.color.size()) {}

void SplatLayer::add(std::span<const Splat> splats) {
  const double radius = filter_radius(filter_);
  for (const Splat& splat : splats) {
    const glm::dvec2 low = splat.place - radius, high = splat.place + radius;
    const int x0 = std::max(window_.x0, static_cast<int>(std::ceil(low.x - 0.5)));
    const int x1 = std::min(window_.x1 - 1, static_cast<int>(std::floor(high.x - 0.5)));
    const int y0 = std::max(window_.y0, static_cast<int>(std::ceil(low.y - 0.5)));
    const int y1 = std::min(window_.y1 - 1, static_cast<int>(std::floor(high.y - 0.5)));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
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
    for (std::size_t k = 0; k < 3; ++k) film.sums.color[i][k] += sums_[i][k];
    if (film.sums.samples[i] == 0) continue;
    film.color[i] = mean_of(film.sums.color[i], film.sums.samples[i]);
  }
}

}  // namespace raygate
