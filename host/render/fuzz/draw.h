// Renders an image of a scene that a reader accepted.
#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>

#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/lights.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/instances.h"
#include "host/scene/view.h"

namespace raygate::test {

/// Renders a few pixels of a scene from its default view, if it has up to 100,000 triangles; aborts
/// if a pixel is not a valid colour. Throws InputError for a scene that is too large for float.
inline void draw(const Scene& scene) {
  if (triangle_count(scene) > 100'000) return;
  const Camera camera =
      Camera::look_at(frame_scene(scene, 1.0, Camera::kDefaultFov,
                                  View{kDefaultAzimuth, kDefaultElevation, scene.up}),
                      1.0);
  const Bvh bvh(scene);
  RenderSettings options;
  options.width = options.height = 4;
  options.samples = 2;
  options.integrator = IntegratorKind::kPath;
  RenderStats stats;
  const PreparedScene prepared(scene, bvh);
  const Film film = render(
      {prepared, camera, options, default_lights(scene, camera)},
      [&] { return std::make_unique<CpuIntersector>(bvh); }, stats);
  for (const glm::vec4& colour : film.color) {
    for (int k = 0; k < 4; ++k) {
      if (!(std::isfinite(colour[k]) && colour[k] >= 0.0f)) std::abort();
    }
  }
}

}  // namespace raygate::test
