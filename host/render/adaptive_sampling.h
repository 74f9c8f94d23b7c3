// Adaptive sampling: chooses the next samples of a tile's pixels by their error, for --error.
#pragma once

#include <cstddef>
#include <vector>

#include "host/render/render_settings.h"

namespace raygate {

/// Errors are estimated per block of 4 x 4 pixels. The estimate of a single pixel can be small by
/// chance, which would stop it early. Blocks form a grid from the frame's upper left corner.
inline constexpr int kErrorBlock = 4;

/// Errors are checked at 8, 16, 32, ... samples per pixel. The first check yields no error
/// estimate, so the second one is the first at which a block can stop.
inline constexpr int kFirstErrorCheck = 8, kMinAdaptiveSamples = 16;

/// Returns the number of samples of the next check after `samples`.
[[nodiscard]] inline int next_error_check(int samples) {
  int check = kFirstErrorCheck;
  while (check <= samples) check *= 2;
  return check;
}

[[nodiscard]] inline bool is_error_check(int samples) {
  return samples >= kFirstErrorCheck && (samples & (samples - 1)) == 0;
}

/// Returns whether pixels are finished. `error`: FilmSums::error; `wanted`: RenderSettings::error.
///
/// A pixel with n samples stops if its error e is at most n / 16 times `wanted`. As e falls with 1
/// / sqrt(n), one more sample reduces e by e / 2n: at the limit, by `wanted` / 32 for every pixel.
/// If s is the standard deviation of one sample, the limit makes n proportional to s^(2/3), which
/// minimises the mean error. A limit independent of n would make n proportional to s^2.
[[nodiscard]] inline bool has_converged(float error, int samples, double wanted) {
  return samples >= kMinAdaptiveSamples && is_error_check(samples) &&
         error <= wanted * samples / kMinAdaptiveSamples;
}

/// Updates FilmSums::error and ::shown of the block whose upper left pixel is (x, y). All pixels of
/// the block must have the same number of samples.
///
/// The error is the root mean square, over the block's pixels, of the change in display steps (see
/// display_steps()) by the last doubling of the samples. With means a and b of the halves of the
/// samples, the mean changes from a to (a + b) / 2, by (b - a) / 2. With independent halves, the
/// expected square of this change would be the variance of (a + b) / 2. Halves of scrambled Sobol
/// points complement each other, so the change overestimates the error slightly. The 95 % interval
/// is 2.12 errors to each side (Student's t with 16 degrees of freedom).
void update_block_error(Film& film, int x, int y, double exposure);

struct PixelSamples {
  int x, y;
  std::size_t index;  ///< index of the pixel in the film
  std::size_t place;  ///< index of the pixel in the tile
  int first, end;     ///< samples [first, end)

  [[nodiscard]] std::size_t path_count() const { return static_cast<std::size_t>(end - first); }
};

/// Returns the samples below `end` that the pixels of `tile` lack. With RenderSettings::error above
/// 0, converged pixels are skipped. If few pixels remain, they take samples beyond `end`, to keep
/// batches large. Pixels are ordered by squares of 8 x 8 pixels, then by blocks of 4 x 2 pixels.
/// This order keeps the rays of an intersector's cones and packets close together.
[[nodiscard]] std::vector<PixelSamples> samples_to_trace(const RenderSettings& settings,
                                                         const Film& film, const PixelRect& tile,
                                                         int end);

}  // namespace raygate
