// Splat layer: light from light paths, at any pixel of a film.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/film/film.h"

namespace raygate {

/// A contribution at a position of the frame, in pixels from its upper left corner.
struct Splat {
  glm::dvec2 place{0.0};
  glm::dvec3 light{0.0};
};

/// Exact sums of splats by pixel of a film's window, each weighted by the density of the pixel's
/// filter. The order of splats does not matter.
class SplatLayer {
 public:
  SplatLayer() = default;  ///< a layer without pixels
  SplatLayer(const PixelRect& window, ReconstructionFilter filter);

  void add(std::span<const Splat> splats);

  /// Adds the splats to the sums of a film, and recomputes its means.
  void add_to(Film& film) const;

 private:
  PixelRect window_;
  ReconstructionFilter filter_ = ReconstructionFilter::kBox;
  std::vector<std::array<ExactAccumulator, 3>> sums_;
};

}  // namespace raygate
