// Emitters that the camera sees, directly, in mirrors and through glass: more rays where they begin
// or end.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator.h"
#include "host/light/ray_batch.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/render_job.h"

namespace raygate {

/// A pixel's set of ways as PathState::emitters has it; kUnknownWays before they are found.
using EmitterWays = std::uint32_t;
inline constexpr EmitterWays kUnknownWays = 0xFFFFFFFF;

/// An emitter is as a rule far brighter than all around it, and the pixels at its edges are the
/// noisiest of a picture, wherever the camera sees it: directly, or by up to four mirrors and
/// borders of glass (PathState::way). What is seen of it costs little to know: no light, no shadow,
/// no choice of a lobe. So in these pixels more rays see emitters and nothing else, and the
/// pixel's samples leave out what emitters send by these ways.
///
/// A pixel has a way if rays through the corners of pixels, as far as its filter reaches, see
/// different emission by it. That depends on no sample, so that more rays where it is so favour
/// nothing. Emitters between all corners, smaller than pixels, are not found.
class EmitterSupersampler {
 public:
  /// The references must outlive this. `counts_work`: asks the intersector for it.
  EmitterSupersampler(const RenderJob& job, Intersector& intersector, bool counts_work);

  /// Sets the ways of a tile's pixels; `ways` is by pixel of the film's window, and `work`, unless
  /// empty, by pixel of the tile: what it takes is added there.
  void find(const Film& film, const PixelRect& tile, std::span<EmitterWays> ways,
            std::span<RayWork> work);

  /// By all ways of each of `pixels`: adds to sums[i] what its samples leave out, and to
  /// work[i], unless that is empty, what it takes.
  void supersample(std::span<const PixelSamples> pixels, std::span<const EmitterWays> ways,
                   std::span<std::array<ExactAccumulator, 3>> sums, std::span<RayWork> work);

  void add_to(RenderStats& stats) const;

 private:
  void add(const Ray& ray, EmitterWays ways);
  void trace();
  /// Of a ray from the camera, by a way.
  [[nodiscard]] const glm::vec3& radiance(std::size_t ray, std::uint32_t way) const {
    return output_.radiance[ray * kSpecularWays + way];
  }

  RenderJob job_;
  Intersector& intersector_;
  Integrator integrator_;
  bool counts_work_;
  EmitterWays all_;     // ways that there may be
  float least_ = 0.0f;  // what is dimmer is left to chance
  RenderStats stats_;
  // Of the rays that are traced together.
  RayBatch batch_;
  ShadingOutput output_;
  std::vector<NearestHit> hits_;
  std::vector<RayWork> work_, ray_work_;
};

}  // namespace raygate
