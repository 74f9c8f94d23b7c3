#include "host/render/adaptive_sampling.h"

#include <algorithm>
#include <cassert>

#include "host/film/display.h"

namespace raygate {

void update_block_error(Film& film, int x, int y, double exposure) {
  FilmSums& sums = film.sums;
  const PixelRect block{x, y, std::min(x + kErrorBlock, film.window.x1),
                        std::min(y + kErrorBlock, film.window.y1)};
  const std::uint32_t samples = sums.samples[film.index_of(x, y)];
  const auto visit = [&](const auto& each) {
    for (int row = block.y0; row < block.y1; ++row) {
      for (int column = block.x0; column < block.x1; ++column) each(film.index_of(column, row));
    }
  };
  double squares = 0.0;
  visit([&](std::size_t i) {
    assert(sums.samples[i] == samples);
    const float shown = display_steps(glm::vec3(film.color[i]), exposure);
    const double change = double{shown} - double{sums.shown[i]};
    sums.shown[i] = shown;
    squares += change * change;
  });
  if (samples < kMinAdaptiveSamples) return;
  const double pixels = static_cast<double>(block.width()) * block.height();
  const auto error = static_cast<float>(std::sqrt(squares / pixels));
  visit([&](std::size_t i) { sums.error[i] = error; });
}

double fraction_done(const Film& film, int most, double wanted) {
  constexpr std::size_t kAsked = 4096;  // pixels, about
  const FilmSums& sums = film.sums;
  const std::size_t step = sums.samples.size() / kAsked | 1;  // odd, to come through all columns
  double taken = 0.0, left = 0.0, judged = 0.0, expected = 0.0, unknown = 0.0;
  for (std::size_t i = 0; i < sums.samples.size(); i += step) {
    const auto samples = static_cast<int>(sums.samples[i]);
    taken += samples;
    if (samples < kMinAdaptiveSamples) {
      ++unknown;
      left -= samples;
      continue;
    }
    double in_the_end = samples;
    if (!has_converged(sums.error[i], samples, wanted) && samples < most) {
      in_the_end = std::min<double>(most, expected_samples(sums.error[i], samples, wanted));
    }
    ++judged;
    expected += in_the_end;
    left += in_the_end - samples;
  }
  // What has not been judged is taken to be like what has.
  left += unknown * (judged > 0.0 ? expected / judged : most);
  return taken + left > 0.0 ? std::clamp(taken / (taken + left), 0.0, 1.0) : 1.0;
}

}  // namespace raygate
