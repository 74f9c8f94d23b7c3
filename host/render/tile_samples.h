// Which samples of a tile's pixels are traced next.
#pragma once

#include <cstddef>
#include <vector>

#include "host/film/film.h"
#include "host/render/renderer.h"

namespace raygate {

struct PixelSamples {
  int x, y;
  std::size_t index;  ///< of the pixel, in the film
  int first, end;     ///< samples [first, end)
};

/// Those that pixels of `tile` lack for having all up to number `end`; with RenderOptions::error,
/// none of pixels that need no more, and some beyond `end` where few pixels do, for a batch to have
/// many rays. Square by square of 8 x 8 pixels, and in them block by block of 4 x 2: intersectors'
/// packets are such blocks, the cones around eight of them such squares.
[[nodiscard]] std::vector<PixelSamples> samples_to_trace(const RenderOptions& options,
                                                         const Film& film, const PixelRect& tile,
                                                         int end);

}  // namespace raygate
