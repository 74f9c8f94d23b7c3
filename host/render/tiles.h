// How a picture is cut up: tiles of pixels, passes of samples.
#pragma once

#include <algorithm>
#include <cstdint>

#include "host/render/film.h"

namespace raygate {

/// The window cut into tiles, numbered row by row, and each pixel's samples into passes, so that a
/// tile's samples of a pass are about 16,384: a batch of their tests is long against the 50 clocks
/// that the pipelined unit takes to run empty at its end, also when 8 lanes share it.
struct Tiles {
  PixelRect window;
  int samples, samples_per_pass;
  int edge, columns, count;

  Tiles(const PixelRect& rect, int samples_per_pixel)
      : window(rect),
        samples(samples_per_pixel),
        samples_per_pass(std::min(samples_per_pixel, 4)),
        edge(samples_per_pass == 1  ? 128
             : samples_per_pass < 4 ? 80
                                    : 64),
        columns((rect.width() + edge - 1) / edge),
        count(columns * ((rect.height() + edge - 1) / edge)) {}

  [[nodiscard]] int passes() const { return (samples + samples_per_pass - 1) / samples_per_pass; }
  [[nodiscard]] int first_sample(int pass) const { return pass * samples_per_pass; }
  [[nodiscard]] int samples_of(int pass) const {
    return std::min(samples_per_pass, samples - first_sample(pass));
  }

  [[nodiscard]] PixelRect operator[](int index) const {
    const int x = window.x0 + index % columns * edge;
    const int y = window.y0 + index / columns * edge;
    return {x, y, std::min(x + edge, window.x1), std::min(y + edge, window.y1)};
  }
};

}  // namespace raygate
