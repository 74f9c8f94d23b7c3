// Splat layer: what light paths have brought to any pixels, beside the film whose tiles are traced.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/film/film.h"
#include "host/film/reconstruction_filter.h"
#include "host/intersect/intersector.h"
#include "host/render/render_job.h"

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
  SplatLayer(const PixelRect& window, ReconstructionFilter filter);
  /// One whose pixels have the light paths of so many samples each: those of a film's sums.
  SplatLayer(const FilmSums& sums, const PixelRect& window, ReconstructionFilter filter);

  void add(std::span<const Splat> splats);

  /// Adds the light of as many samples as each pixel of a film with sums has to these, and to its
  /// means; or takes it away again, exactly.
  void add_to(Film& film) const { add_to(film, 1.0); }
  void take_from(Film& film) const { add_to(film, -1.0); }
  /// Of a pixel, where there are samples: the light of one.
  [[nodiscard]] glm::vec4 mean(std::size_t pixel) const {
    return glm::vec4(mean_of(sums_[pixel], samples_[pixel]), 0.0f);
  }

 private:
  void add_to(Film& film, double times) const;

  PixelRect window_;
  ReconstructionFilter filter_ = ReconstructionFilter::kBox;
  std::vector<std::array<ExactAccumulator, 3>> sums_;
  std::vector<std::uint32_t> samples_;  // none: as many as the film has
};

/// With RenderOptions::error, traces all light paths before the first camera path: their noise is
/// their own, and no camera path makes it less. The whole frame's, in passes of 8, 8, 16, 32, ...
/// samples, as long as any block (adaptive_sampling.h) needs more; a block keeps those that it
/// needs, by the same rule as camera samples, as a display would show them on middle grey. So what
/// a block gets depends on no other block, nor on how many samples may follow: crops, ranks and
/// resumed renders have the same light.
///
/// `film`: whose window counts. Adds to `stats`, whose `cancelled` says that the monitor wanted no
/// more: then the layer is of no use.
[[nodiscard]] SplatLayer adaptive_splats(const RenderJob& job, const Film& film,
                                         const IntersectorFactory& make_intersector,
                                         const RenderMonitor& monitor, RenderStats& stats);

}  // namespace raygate
