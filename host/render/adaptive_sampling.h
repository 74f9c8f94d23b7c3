// Adaptive sampling: chooses the next samples of a tile's pixels by their error, for --error.
#pragma once

#include <cstddef>
#include <vector>

#include "host/render/render_settings.h"

namespace raygate {

/// Errors are estimated per block of 4 x 4 pixels, so that a pixel with a small error by chance
/// does not stop early. Blocks form a grid from the frame's upper left corner and are independent.
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

/// Returns whether pixels need no more samples. `error` is FilmSums::error, `wanted`
/// RenderSettings::error.
///
/// A pixel with n samples stops if its error is at most n / 16 times `wanted`. One more sample
/// reduces an error e by e / 2n, so this rule stops every pixel at the same gain per sample. A
/// limit independent of n would distribute samples in proportion to the squared noise s^2 of a
/// sample; the mean error is smallest for s^(2/3).
[[nodiscard]] inline bool has_converged(float error, int samples, double wanted) {
  return samples >= kMinAdaptiveSamples && is_error_check(samples) &&
         error <= wanted * samples / kMinAdaptiveSamples;
}

/// Updates FilmSums::error and ::shown of the block whose first pixel is (x, y). All its pixels
/// must have the same number of samples.
///
/// The error is the root mean square, over the block, of changes in display steps (display_steps)
/// by the last doubling of the samples. If the halves of the samples were independent, its expected
/// square would be the variance of the mean: for means a and b, the change is (b - a) / 2. Halves
/// of scrambled Sobol points complement each other, so the change overestimates the error slightly.
/// The 95 % interval is 2.12 errors to each side (Student's t with 16 degrees of freedom).
void update_block_error(Film& film, int x, int y, double exposure);

struct PixelSamples {
  int x, y;
  std::size_t index;  ///< of the pixel, in the film
  std::size_t place;  ///< of the pixel, in the tile
  int first, end;     ///< samples [first, end)

  [[nodiscard]] std::size_t path_count() const { return static_cast<std::size_t>(end - first); }
};

/// Returns the samples below `end` that the pixels of `tile` lack. With RenderSettings::error,
/// pixels that have converged are skipped, and if few remain they take samples beyond `end`, so
/// that batches have many rays. Pixels are ordered by squares of 8 x 8 and within these by blocks
/// of 4 x 2, which become the cones and packets of intersectors.
[[nodiscard]] std::vector<PixelSamples> samples_to_trace(const RenderSettings& settings,
                                                         const Film& film, const PixelRect& tile,
                                                         int end);

}  // namespace raygate
