// The renderer: from a scene and a camera to a film.
#pragma once

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/prepared_scene.h"
#include "host/render/render_options.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// The prepared scene is for renders to share, one after the other or at once.
/// The film is the same, bit for bit, for every intersector, number of threads and skip, and a
/// window's is that part of the whole one's. An exception of an intersector ends the render and is
/// thrown on. Scenes without any light are black, but for kPrimary: see default_lights.
[[nodiscard]] Film render(const PreparedScene& prepared, const Camera& camera,
                          const RenderOptions& options, const IntersectorFactory& make_intersector,
                          RenderStats& stats, const RenderMonitor& monitor = {});

/// The same for a scene that is rendered once.
[[nodiscard]] inline Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                                 const RenderOptions& options,
                                 const IntersectorFactory& make_intersector, RenderStats& stats,
                                 const RenderMonitor& monitor = {}) {
  return render(PreparedScene(scene, bvh), camera, options, make_intersector, stats, monitor);
}

}  // namespace raygate
