// Render context: read-only data shared by all threads of a render, and camera rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "host/light/light_paths.h"
#include "host/render/render_settings.h"

namespace raygate {

struct RenderContext {
  const PreparedScene& prepared;
  const Camera& camera;
  const RenderSettings& settings;
  const Lights& lights;                     ///< the scene's lights, or camera lights
  const LightPaths* light_paths = nullptr;  ///< null: only camera paths find caustics
};

/// Returns the query for a batch of rays. `work` is empty or has the size of the batch.
[[nodiscard]] inline RayQuery query_of(const RenderContext& context, const RayBatch& batch,
                                       std::span<RayWork> work) {
  return {.common_origin = batch.depth == 0 && context.camera.is_pinhole(),
          .source_ids = batch.sources,
          .work = work};
}

// Streams of a pixel's random numbers.
inline constexpr std::uint32_t kFilterStream = 0, kEmitterStream = 7, kLensStream = 8;

/// Returns the camera ray of sample `index` of a pixel. `key`: pixel_key() of the pixel; `stream`:
/// random stream of the positions in the pixel's filter. With one sample per pixel the ray goes
/// through the centres of pixel and lens.
[[nodiscard]] RAYGATE_INLINE Ray camera_ray(const RenderContext& context, int pixel_x, int pixel_y,
                                            std::uint32_t key, std::uint32_t index,
                                            std::uint32_t stream) {
  const RenderSettings& settings = context.settings;
  const Camera& camera = context.camera;
  glm::dvec2 offset(0.0), lens(0.0);
  if (settings.samples > 1) {
    const auto u = random_point<float>(index, key, stream);
    offset = filter_offset(settings.filter, {u.x, u.y});
  }
  const double x = (pixel_x + 0.5 + offset.x) / settings.width;
  const double y = (pixel_y + 0.5 + offset.y) / settings.height;
  if (camera.is_pinhole()) return {camera.eye(), camera.direction(x, y)};
  if (settings.samples > 1 && camera.aperture() > 0.0) {
    const auto u = random_point<float>(index, key, kLensStream);
    lens = {u.x, u.y};
  }
  return camera.ray(x, y, lens);
}

}  // namespace raygate
