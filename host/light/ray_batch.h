// Ray batches: rays of one depth with the states of their paths, and the results of shading them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/exact/exact.h"
#include "host/light/shadow_rays.h"

namespace raygate {

/// The state of a path along its ray: a record of 16 words, since hits are shaded in another order
/// than rays are traced in, and one cache line is fetched for a ray, not ten. PathLanes has the
/// fields of several.
struct alignas(16) PathState {
  glm::vec3 throughput{1.0f};  ///< what light along the ray is multiplied by
  /// Per steradian, of sampling this direction where a surface scattered the ray; 0 where there was
  /// no choice (camera, mirror, glass).
  float pdf = 0.0f;
  glm::vec3 scattered_at{0.0f};  ///< and where
  glm::vec3 normal{0.0f};        ///< of the surface there
  std::uint32_t sample = 0;      ///< of those that are traced together: whose radiance it adds to
  std::uint32_t stream = 0;      ///< of random numbers, its own in the picture
  std::uint32_t index = 0;       ///< of its points in such streams
  /// What the camera sees by: 1 for a ray of its own, 2w for what w sees in a mirror, 2w + 1 for
  /// what it sees through glass that bends; below kSpecularWays. Light paths begin with 1, too.
  /// Then one of those below, or 0.
  std::uint32_t way = 1;
  /// How dense light paths are here over how dense camera paths are, or on light paths the other
  /// way round (LightPaths); 0: there is one kind alone.
  float ratio = 0.0f;
  /// By which ways emitters are not counted, for other rays see them: bit w for way w. Of those
  /// rays: by which ways they go (EmitterSupersampler).
  std::uint32_t emitters = 0;
};

/// PathState::way of what the camera sees by four mirrors and borders of glass at most is less.
inline constexpr std::uint32_t kSpecularWays = 32;

/// PathState::way after a surface that scatters and that the camera sees in mirrors or through
/// glass: of the path, and of the rays that look for caustics there (sample_seen_caustics).
inline constexpr std::uint32_t kFromSeen = 32, kCausticRay = 34;
/// The same after a mirror or glass behind it.
inline constexpr std::uint32_t kBySpecular = 1;

/// Rays with the same number of surfaces behind them.
struct RayBatch {
  int depth = 0;  ///< so many; 0: from the camera
  std::vector<Ray> rays;
  std::vector<PathState> states;       ///< of the rays
  std::vector<std::uint32_t> sources;  ///< the primitives that they leave; none from the camera

  void clear() {
    rays.clear();
    states.clear();
    sources.clear();
  }
};

/// The first surface that a camera ray meets; holes of masks are no surface.
struct FirstSurface {
  std::uint32_t primitive = NearestHit::kNone;
  glm::vec3 origin{0.0f};  ///< of the ray that meets it, of a pixel's first sample only
  glm::vec3 point{0.0f};   ///< relative to `origin`
  glm::vec3 normal{0.0f}, albedo{0.0f};
};

/// The results of shading a batch.
struct ShadingOutput {
  std::vector<glm::vec3> radiance;          ///< by sample
  std::vector<FirstSurface> first_surface;  ///< by sample
  std::vector<ShadowRay> shadows;           ///< light still to arrive
  RayBatch next;                            ///< the rays that go on
};

}  // namespace raygate
