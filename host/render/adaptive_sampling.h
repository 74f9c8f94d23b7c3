// Adaptive sampling: which samples a tile's pixels take next, by their error if --error asks for
// it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "host/film/film.h"
#include "host/render/render_options.h"

namespace raygate {

/// The neighbourhood that is judged as one, so that a pixel that happens to be right is not left:
/// a block of 4 x 4 pixels, of a grid that begins at the frame's upper left corner. Nothing else
/// has a say in whether its pixels get more samples. So it does not matter what is
/// rendered together, as long as blocks are whole.
inline constexpr int kErrorBlock = 4;

/// Looks are at 8, 16, 32, ... samples a pixel; the first tells no error yet, the second is the
/// first after which a block may be done.
inline constexpr int kFirstErrorCheck = 8, kMinAdaptiveSamples = 16;

/// The first look after `samples` of them.
[[nodiscard]] inline int next_error_check(int samples) {
  int look = kFirstErrorCheck;
  while (look <= samples) look *= 2;
  return look;
}

[[nodiscard]] inline bool is_error_check(int samples) {
  return samples >= kFirstErrorCheck && (samples & (samples - 1)) == 0;
}

/// Whether pixels of so many samples need no more, if FilmSums::error says `error`, and `wanted`
/// is RenderOptions::error.
///
/// A pixel may stop at its first look if its error is `wanted` or less. With n samples it
/// may have n / 16 times that: one more sample lowers an error e by e / 2n, and this rule
/// stops where that is no longer worth it, whatever the pixel. A limit that is the same for all n
/// would give pixels samples by the square of their noise (s, of one sample), where the mean error
/// is least for the samples if they get them by the power 2/3.
[[nodiscard]] inline bool has_converged(float error, int samples, double wanted) {
  return samples >= kMinAdaptiveSamples && is_error_check(samples) &&
         error <= wanted * samples / kMinAdaptiveSamples;
}

/// How many samples a pixel will have before that, if its error goes on falling as 1 / sqrt(n).
/// At least `samples` + 1.
[[nodiscard]] inline double expected_samples(float error, int samples, double wanted) {
  const double noise = double{error} * std::sqrt(samples);
  return std::max(samples + 1.0, std::cbrt(std::pow(kMinAdaptiveSamples * noise / wanted, 2.0)));
}

/// Looks at the block from pixel (x, y) on, all of whose pixels have the same number of samples:
/// sets FilmSums::error and ::shown there.
///
/// The error is how much the last doubling of the samples has changed what a display shows
/// (display_steps), root mean square over the block. If halves of the samples were independent,
/// the square of that would be the variance of the mean, on average: with means a and b, the whole
/// is (a + b) / 2, a change of (b - a) / 2. They are scrambled Sobol points, whose halves
/// fill each other's gaps, so the change is a little larger than the error, never smaller on
/// average. The interval of 95 % is 2.12 errors to each side: Student's t of 16 numbers.
void update_block_error(Film& film, int x, int y, double exposure);

/// The share of a render that is done, in [0, 1], by `film`; samples of up to `most` a pixel.
[[nodiscard]] double fraction_done(const Film& film, int most, double wanted);

struct PixelSamples {
  int x, y;
  std::size_t index;  ///< of the pixel, in the film
  int first, end;     ///< samples [first, end)

  [[nodiscard]] std::size_t path_count() const { return static_cast<std::size_t>(end - first); }
};

/// Those that pixels of `tile` lack for having all up to number `end`; with RenderOptions::error,
/// none of pixels that need no more, and some beyond `end` where few pixels do, for a batch to have
/// many rays. Square by square of 8 x 8 pixels, and in them block by block of 4 x 2: intersectors'
/// packets are such blocks, the cones around eight of them such squares.
[[nodiscard]] std::vector<PixelSamples> samples_to_trace(const RenderOptions& options,
                                                         const Film& film, const PixelRect& tile,
                                                         int end);

}  // namespace raygate
