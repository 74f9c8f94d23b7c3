#include "host/render/adaptive_splats.h"

#include <algorithm>
#include <cmath>

#include "host/render/adaptive_sampling.h"
#include "host/render/coordinator.h"
#include "host/render/tiles.h"

namespace raygate {
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
  RenderJob own{job.prepared, job.camera, options, job.lights, job.ambient, job.light_paths};
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
