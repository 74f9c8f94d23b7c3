// What the samples of each pixel add up to: what a picture goes on from.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/film/exact_accumulator.h"

namespace raygate {

/// Arrays of a film's pixels, in its order.
struct FilmSums {
  std::vector<std::uint32_t> samples;  ///< how many
  std::vector<std::array<ExactAccumulator, 4>> color;
  std::vector<std::array<ExactAccumulator, 3>> albedo;  ///< if the film has it
  // Of films whose pixels get samples by their error: as of the last look, see
  // render/sample_choice.h. In steps of an 8-bit display.
  std::vector<float> error;  ///< standard error, estimated; infinite before there is an estimate
  std::vector<float> shown;  ///< what a display shows
};

/// The mean of so many samples, as a film has it: not negative, whatever
/// small number rounding has left.
template <std::size_t N>
[[nodiscard]] glm::vec<N, float> mean_of(const std::array<ExactAccumulator, N>& sums,
                                         double samples) {
  glm::vec<N, float> mean;
  for (std::size_t k = 0; k < N; ++k) {
    mean[static_cast<int>(k)] = static_cast<float>(std::max(sums[k].value(), 0.0) / samples);
  }
  return mean;
}

}  // namespace raygate
