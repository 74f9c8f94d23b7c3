// Splat layer: what light paths have brought to any pixels, beside the film whose tiles are traced.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/film/exact_accumulator.h"
#include "host/film/film.h"
#include "host/film/reconstruction_filter.h"

namespace raygate {

/// Light that arrives at a place of the frame, in pixels from its upper left corner.
struct Splat {
  glm::dvec2 place{0.0};
  glm::dvec3 light{0.0};
};

/// Sums of splats, by pixel of a film's window, each with the density of the pixel's filter there.
/// They are exact, so it does not matter who brings which splat when. Empty until it is reset.
class SplatLayer {
 public:
  SplatLayer() = default;
  SplatLayer(const Film& film, ReconstructionFilter filter);

  void add(std::span<const Splat> splats);

  /// Adds all to a film with sums, whose samples have as many light paths, and to its means.
  void add_to(Film& film) const;

 private:
  PixelRect window_;
  ReconstructionFilter filter_ = ReconstructionFilter::kBox;
  std::vector<std::array<ExactAccumulator, 3>> sums_;
};

}  // namespace raygate
