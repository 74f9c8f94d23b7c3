#include "host/render/splat_layer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/render/adaptive_sampling.h"
#include "host/render/coordinator.h"
#include "host/render/tiles.h"

namespace raygate {

SplatLayer::SplatLayer(const PixelRect& window, ReconstructionFilter filter)
    : window_(window),
      filter_(filter),
      sums_(std::size_t(window.width()) * std::size_t(window.height())) {}

SplatLayer::SplatLayer(const FilmSums& sums, const PixelRect& window, ReconstructionFilter filter)
    : SplatLayer(window, filter) {
  for (std::size_t i = 0; i < sums_.size(); ++i)
    std::copy_n(sums.color[i].begin(), 3, sums_[i].begin());
  samples_ = sums.samples;
}

void SplatLayer::add(std::span<const Splat> splats) {
  const double radius = filter_radius(filter_);
  for (const Splat& splat : splats) {
    const glm::dvec2 low = splat.place - radius, high = splat.place + radius;
    // Places may be farther away than an int can say.
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

void SplatLayer::add_to(Film& film, double times) const {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const std::uint32_t samples = film.sums.samples[i];
    for (std::size_t k = 0; k < 3; ++k) {
      ExactAccumulator& sum = film.sums.color[i][k];
      if (samples_.empty()) {
        sum += times < 0.0 ? -sums_[i][k] : sums_[i][k];
      } else {
        sum.add(times * (sums_[i][k].value() / samples_[i] * samples));
      }
    }
    if (samples != 0) film.color[i] = mean_of(film.sums.color[i], samples);
  }
}

namespace {

constexpr int kMostSamples = 1 << 12;
constexpr float kMiddleGrey = 0.18f;  // on a display

/// The light paths so far, as a film whose samples they are.
class Judge {
 public:
  Judge(const Film& film, const RenderOptions& options)
      : options_(options), film_(make_film(film.width, film.height, film.window, {})) {
    add_sums(film_, true);
  }

  /// Adds a pass of those after `first` up to `end` to the blocks that need it.
  void add(const Film& pass, int first, int end) {
    for_blocks([&](int x, int y) {
      if (needs_no_more(x, y)) return;
      for_pixels(x, y, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) film_.sums.color[i][k] += pass.sums.color[i][k];
        film_.sums.samples[i] += static_cast<std::uint32_t>(end - first);
        film_.color[i] = mean_of(film_.sums.color[i], film_.sums.samples[i]) + ground_;
      });
      update_block_error(film_, x, y, options_.exposure);
    });
  }

  [[nodiscard]] bool is_enough() const {
    bool is_enough = true;
    for_blocks([&](int x, int y) { is_enough = is_enough && needs_no_more(x, y); });
    return is_enough;
  }

  [[nodiscard]] SplatLayer layer() const { return {film_.sums, film_.window, options_.filter}; }

 private:
  template <class Visit>
  void for_blocks(const Visit& visit) const {
    const PixelRect& window = film_.window;
    for (int y = window.y0; y < window.y1; y += kErrorBlock) {
      for (int x = window.x0; x < window.x1; x += kErrorBlock) visit(x, y);
    }
  }
  template <class Visit>
  void for_pixels(int x, int y, const Visit& visit) const {
    for (int row = y; row < std::min(y + kErrorBlock, film_.window.y1); ++row) {
      for (int column = x; column < std::min(x + kErrorBlock, film_.window.x1); ++column) {
        visit(film_.index_of(column, row));
      }
    }
  }
  [[nodiscard]] bool needs_no_more(int x, int y) const {
    const std::size_t i = film_.index_of(x, y);
    return has_converged(film_.sums.error[i], static_cast<int>(film_.sums.samples[i]),
                         options_.error);
  }

  const RenderOptions& options_;
  Film film_;
  const glm::vec4 ground_{
      glm::vec3(kMiddleGrey * std::exp2(-static_cast<float>(options_.exposure))), 0.0f};
};

}  // namespace

SplatLayer adaptive_splats(const RenderJob& job, const Film& film,
                           const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                           RenderStats& stats) {
  RenderOptions options = job.options;
  options.error = 0.0;
  options.ranks = nullptr;  // each rank has need of all of them
  options.unfinished = nullptr;
  options.channels = {};
  RenderJob own{job.prepared, job.camera, options, job.lights, job.light_paths};
  own.only_light_paths = true;
  RenderMonitor quiet;
  quiet.progress = [&](double /*of a pass*/) { return !monitor.progress || monitor.progress(0.0); };
  Judge judge(film, job.options);
  for (int first = 0; first < kMostSamples && !judge.is_enough();) {
    const int end = next_error_check(first);
    options.first_sample = first;
    options.end_sample = end;
    Film pass = make_film(film.width, film.height, film.window, {});
    add_sums(pass, false);
    auto intersector = make_intersector();
    const Tiles tiles(film.window, end - first, intersector->preferred_batch(), options.threads);
    run_coordinator(own, tiles, std::move(intersector), make_intersector, quiet, pass, {}, stats);
    if (stats.cancelled) break;
    judge.add(pass, first, end);
    first = end;
  }
  return judge.layer();
}

}  // namespace raygate
