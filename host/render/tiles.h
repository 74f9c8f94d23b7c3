// Tiles: the cut of a picture into tiles of pixels and passes of samples.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "host/film/film.h"

namespace raygate {

/// The window cut into tiles, numbered row by row, and each pixel's samples into passes, so that a
/// tile's samples of a pass are about as many as an intersector prefers in a batch. Fewer where
/// some of the threads would have no tile; and where there are other ranks, smaller tiles and
/// longer passes, unless these are to stay short, as long as a thread has not four tiles.
struct Tiles {
  PixelRect window;
  int samples, samples_per_pass;
  int width, height;  ///< of a tile
  int columns, count;

  /// `batch`: Intersector::preferred_batch. `threads` of each of so many `ranks`.
  Tiles(const PixelRect& rect, int samples_per_pixel, std::size_t batch, int threads, int ranks = 1,
        bool short_passes = false)
      : window(rect), samples(samples_per_pixel), samples_per_pass(std::min(samples_per_pixel, 4)) {
    int edge = samples_per_pass == 1 ? 128 : samples_per_pass < 4 ? 80 : 64;
    const std::int64_t share =
        std::int64_t{window.width()} * window.height() / (std::int64_t{threads} * ranks);
    for (; ranks > 1 && edge > 16 && share < std::int64_t{4} * edge * edge; edge /= 2) {
      if (!short_passes) samples_per_pass = std::min(samples, 4 * samples_per_pass);
    }
    const int square = edge * edge;
    const auto many = static_cast<std::int64_t>(batch) / samples_per_pass;
    const int pixels = static_cast<int>(
        std::clamp(share, std::int64_t{square}, std::max<std::int64_t>(square, many)));
    width = pixels / edge;
    // Whole squares of 8 x 8 pixels, which are traced together.
    width = (width + 7) / 8 * 8;
    if (2 * width > window.width()) width = window.width();
    height = (pixels / width + 7) / 8 * 8;
    columns = (window.width() + width - 1) / width;
    count = columns * ((window.height() + height - 1) / height);
  }

  [[nodiscard]] int passes() const { return (samples + samples_per_pass - 1) / samples_per_pass; }
  /// How many samples a pixel has after a pass.
  [[nodiscard]] int samples_after(int pass) const {
    return std::min(samples, (pass + 1) * samples_per_pass);
  }

  [[nodiscard]] PixelRect operator[](int index) const {
    const int x = window.x0 + index % columns * width;
    const int y = window.y0 + index / columns * height;
    return {x, y, std::min(x + width, window.x1), std::min(y + height, window.y1)};
  }
};

}  // namespace raygate
