// The renderer: from a scene and a camera to a film.
#pragma once

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/neighbor_clearance.h"
#include "host/render/render_options.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// The clearances are for renders of the same tree to share, one after the other or at once.
/// The film is the same, bit for bit, for every intersector, number of threads and skip, and a
/// window's is that part of the whole one's. An exception of an intersector ends the render and is
/// thrown on. Scenes without any light are black, but for kPrimary: see add_default_lights.
[[nodiscard]] Film render(const Scene& scene, const NeighborClearances& clearances,
                          const Camera& camera, const RenderOptions& options,
                          const IntersectorFactory& make_intersector, RenderStats& stats,
                          const RenderMonitor& monitor = {});

/// The same for a tree that is rendered once.
[[nodiscard]] inline Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                                 const RenderOptions& options,
                                 const IntersectorFactory& make_intersector, RenderStats& stats,
                                 const RenderMonitor& monitor = {}) {
  return render(scene, NeighborClearances(bvh), camera, options, make_intersector, stats, monitor);
}

}  // namespace raygate
