// Ray batches: rays of one depth with their path states, and the results of shading their hits.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/light/shadow_rays.h"

namespace raygate {

/// The state of a path along its current ray. Its 16 words share a cache line, because hits are
/// shaded in another order than rays are traced. PathLanes holds several paths, field by field.
struct alignas(16) PathState {
  glm::vec3 throughput{1.0f};  ///< factor of light that arrives along the ray
  /// Probability density per steradian of this direction at the last scattering event; 0 if the
  /// event was a delta distribution (mirror, smooth glass) or the camera.
  float pdf = 0.0f;
  glm::vec3 scattered_at{0.0f};  ///< position of the last scattering event
  glm::vec3 normal{0.0f};        ///< shading normal at scattered_at
  std::uint32_t sample = 0;      ///< index of the radiance, in ShadingOutput, that the path adds to
  std::uint32_t stream = 0;      ///< stream of random numbers, different for each path
  std::uint32_t index = 0;       ///< index of the path's point in each stream
  /// A code of the mirrors and smooth glass that the path has met: 1 for the first ray; a mirror
  /// turns code h into 2 h, glass into 2 h + 1. 0: the path met more than four, or another surface.
  std::uint32_t specular_history = 1;
  /// Density of light paths over the density of camera paths, for the path so far; on light paths
  /// the inverse (see LightPaths). 0: only one kind of path finds the light, so it has full weight.
  float light_over_camera_pdf = 0.0f;
  /// Bit mask of specular histories at which emission is omitted because EmitterSupersampler adds
  /// it. In rays of EmitterSupersampler: the histories to follow.
  std::uint32_t supersampled = 0;
};

/// Codes of specular histories of at most four bounces are below this.
inline constexpr std::uint32_t kSpecularHistories = 32;

/// Rays of the same depth.
struct RayBatch {
  int depth = 0;  ///< number of surfaces met so far; 0: camera rays
  std::vector<Ray> rays;
  std::vector<PathState> states;       ///< by ray
  std::vector<std::uint32_t> sources;  ///< by ray: the primitive it leaves; empty for camera rays

  void clear() {
    rays.clear();
    states.clear();
    sources.clear();
  }
};

/// The first surface on a camera ray; masked-out holes do not count.
struct FirstSurface {
  std::uint32_t primitive = NearestHit::kNone;
  glm::vec3 origin{0.0f};  ///< of the ray that meets it; only in a pixel's first sample
  glm::vec3 point{0.0f};   ///< relative to `origin`
  glm::vec3 normal{0.0f}, albedo{0.0f};
};

/// The results of shading a batch.
struct ShadingOutput {
  std::vector<glm::vec3> radiance;          ///< by sample
  std::vector<FirstSurface> first_surface;  ///< by sample
  std::vector<ShadowRay> shadows;           ///< shadow rays to trace
  RayBatch next;                            ///< scattered rays to trace
  std::uint64_t point_doubts = 0;           ///< number of hit points P that the host computed
};

}  // namespace raygate
