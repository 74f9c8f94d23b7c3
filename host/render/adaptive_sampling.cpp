#include "host/render/adaptive_sampling.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "host/film/display.h"

namespace raygate {
namespace {

constexpr int kBlockWidth = 4, kBlockHeight = 2;
static_assert(kErrorBlock % kBlockWidth == 0 && kErrorBlock % kBlockHeight == 0);
constexpr int kSquare = 8;
constexpr std::size_t kManySamples = 1 << 14;  // per batch

/// Visits blocks of up to width x height that cover `rect`, row by row.
template <class Visit>
void for_blocks(const PixelRect& rect, int width, int height, const Visit& visit) {
  for (int y = rect.y0; y < rect.y1; y += height) {
    for (int x = rect.x0; x < rect.x1; x += width) {
      visit(PixelRect{x, y, std::min(x + width, rect.x1), std::min(y + height, rect.y1)});
    }
  }
}

/// Returns whether the pixels of a block have converged, by RenderSettings::error.
bool needs_no_more(const RenderSettings& settings, const Film& film, const PixelRect& block) {
  if (settings.error == 0.0) return false;
  const std::size_t index = film.index_of(block.x0, block.y0);
  return has_converged(film.sums.error[index], static_cast<int>(film.sums.samples[index]),
                       settings.error);
}

/// Returns the number of samples that each unconverged pixel may take in one batch.
int samples_ahead(const RenderSettings& settings, const Film& film, const PixelRect& tile,
                  int end) {
  if (settings.error == 0.0) return 0;
  std::size_t pixels = 0;
  for_blocks(tile, kErrorBlock, kErrorBlock, [&](const PixelRect& block) {
    const std::size_t index = film.index_of(block.x0, block.y0);
    if (static_cast<int>(film.sums.samples[index]) >= end || needs_no_more(settings, film, block))
      return;
    pixels += static_cast<std::size_t>(block.width() * block.height());
  });
  return static_cast<int>(kManySamples / std::max<std::size_t>(1, pixels));
}

}  // namespace

void update_block_error(Film& film, int x, int y, double exposure) {
  FilmSums& sums = film.sums;
  const PixelRect block{x, y, std::min(x + kErrorBlock, film.window.x1),
                        std::min(y + kErrorBlock, film.window.y1)};
  const std::uint32_t samples = sums.samples[film.index_of(x, y)];
  const auto visit = [&](const auto& each) {
    for_blocks(block, 1, 1,
               [&](const PixelRect& pixel) { each(film.index_of(pixel.x0, pixel.y0)); });
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

std::vector<PixelSamples> samples_to_trace(const RenderSettings& settings, const Film& film,
                                           const PixelRect& tile, int end) {
  std::vector<PixelSamples> pixels;
  const int ahead = samples_ahead(settings, film, tile, end);
  const std::vector<std::uint32_t>& done = film.sums.samples;
  for_blocks(tile, kSquare, kSquare, [&](const PixelRect& square) {
    for_blocks(square, kBlockWidth, kBlockHeight, [&](const PixelRect& block) {
      if (needs_no_more(settings, film, block)) return;
      for_blocks(block, 1, 1, [&](const PixelRect& pixel) {
        const std::size_t index = film.index_of(pixel.x0, pixel.y0);
        const int first =
            settings.first_sample + (done.empty() ? 0 : static_cast<int>(done[index]));
        if (first >= end) return;
        const int last =
            std::max(end, std::min({first + ahead, next_error_check(first), settings.samples}));
        const std::size_t place = tile.index_of(pixel.x0, pixel.y0);
        pixels.push_back({pixel.x0, pixel.y0, index, place, first, last});
      });
    });
  });
  return pixels;
}

}  // namespace raygate
