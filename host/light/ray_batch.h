// Rays of one depth, and what their surfaces give.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/exact/exact.h"
#include "host/light/shadow_rays.h"

namespace raygate {

/// What a ray of light carries. Fifty-two bytes in a row: hits are shaded in another order than
/// rays are traced in, and one cache line is fetched for a ray, not ten.
struct PathState {
  glm::vec3 throughput{1.0f};  ///< what light that comes along the ray counts for
  /// Where a surface scattered it: how likely that was to give this direction, per steradian;
  /// 0 where there was no choice (camera, mirror, glass).
  float pdf = 0.0f;
  glm::vec3 scattered_at{0.0f};  ///< and where
  glm::vec3 normal{0.0f};        ///< of the surface there
  std::uint32_t sample = 0;      ///< of those that are traced together: whose radiance it adds to
  std::uint32_t stream = 0;      ///< of random numbers, its own in the picture
  std::uint32_t index = 0;       ///< of its points in such streams
};

/// Rays with the same number of surfaces behind them.
struct RayBatch {
  int depth = 0;  ///< so many; 0: from the camera
  std::vector<Ray> rays;
  std::vector<PathState> states;  ///< of the rays

  void clear() {
    rays.clear();
    states.clear();
  }
};

/// What a camera ray's surface looks like.
struct FirstSurface {
  glm::vec3 normal{0.0f}, albedo{0.0f};
};

/// What the surfaces of a batch give.
struct ShadingOutput {
  std::vector<glm::vec3> radiance;          ///< by sample
  std::vector<FirstSurface> first_surface;  ///< by sample
  std::vector<ShadowRay> shadows;           ///< light still to arrive
  RayBatch next;                            ///< the rays that go on
};

}  // namespace raygate
