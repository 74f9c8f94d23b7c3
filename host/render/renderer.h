// The renderer: renders a scene with a camera into a film.
#pragma once

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/prepared_scene.h"
#include "host/render/render_options.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// Renders a picture. Several renders can share the prepared scene, also at the same time. The film
/// does not depend, in any bit, on the intersector, the number of threads or the skips, and the
/// film of a window is a part of the whole film. Rethrows exceptions of intersectors. A scene
/// without lights is black except with kPrimary: see default_lights.
[[nodiscard]] Film render(const PreparedScene& prepared, const Camera& camera,
                          const RenderOptions& options, const IntersectorFactory& make_intersector,
                          RenderStats& stats, const RenderMonitor& monitor = {});

/// Renders a scene that is not prepared.
[[nodiscard]] inline Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                                 const RenderOptions& options,
                                 const IntersectorFactory& make_intersector, RenderStats& stats,
                                 const RenderMonitor& monitor = {}) {
  return render(PreparedScene(scene, bvh), camera, options, make_intersector, stats, monitor);
}

}  // namespace raygate
