// Emitter supersampler: extra rays at outlines of emitters seen directly, in mirrors or in glass.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/light/integrator.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/render_context.h"

namespace raygate {

/// Set of specular histories (see PathState): bit h is history h. kUnknownHistories: not found yet.
using HistoryMask = std::uint32_t;
inline constexpr HistoryMask kUnknownHistories = 0xFFFFFFFF;

/// Supersamples the outlines of emitters that the camera sees directly or through up to four
/// mirrors and glass interfaces. Emitters are much brighter than their surroundings, so the pixels
/// on their outlines are the noisiest. Additional rays collect only emission. They are cheap: they
/// sample no lights and no lobes. The pixels' own samples omit this emission.
///
/// find() traces a ray through each pixel corner within the radius of a pixel's filter. A history
/// is in the pixel's mask if rays with this history find different emission. No mask depends on
/// samples, so there is no bias. Emitters that no ray through a corner meets are missed.
class EmitterSupersampler {
 public:
  /// The references must outlive this object. `counts_work`: whether tests and doubts are counted.
  /// Adds the numbers of rays and `point_doubts`, and the shading time, to `stats`.
  EmitterSupersampler(const RenderContext& context, Intersector& intersector, bool counts_work,
                      RenderStats& stats);

  /// Sets the histories of a tile's pixels. `histories` is indexed by pixel of the film's window.
  /// Adds the work to `work`, indexed by pixel of the tile, unless `work` is empty.
  void find(const Film& film, const PixelRect& tile, std::span<HistoryMask> histories,
            std::span<RayWork> work);

  /// Adds to sums[i] the emission that samples of pixels[i] omit. `work` is as in find().
  void supersample(std::span<const PixelSamples> pixels, std::span<const HistoryMask> histories,
                   std::span<std::array<ExactAccumulator, 3>> sums, std::span<RayWork> work);

 private:
  void add(const Ray& ray, HistoryMask histories);
  void trace();
  [[nodiscard]] const glm::vec3& radiance(std::size_t ray, std::uint32_t history) const {
    return output_.radiance[ray * kSpecularHistories + history];
  }

  RenderContext context_;
  Intersector& intersector_;
  Integrator integrator_;
  bool counts_work_;
  HistoryMask all_;     // histories that can occur
  float least_ = 0.0f;  // least radiance that is supersampled
  RenderStats& stats_;
  RayBatch batch_;
  ShadingOutput output_;
  std::vector<NearestHit> hits_;
  std::vector<RayWork> work_, ray_work_;
};

}  // namespace raygate
