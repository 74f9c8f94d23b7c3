// Renderer: renders a scene with a camera into a film.
#pragma once

#include <optional>

#include "host/light/prepared_scene.h"
#include "host/render/render_settings.h"
#include "host/scene/camera.h"

namespace raygate {

/// An image to render. The references must outlive the call of render().
struct RenderJob {
  const PreparedScene& prepared;
  const Camera& camera;
  const RenderSettings& settings;
  std::optional<CameraLights> lights{};  ///< replace the scene's lights
  /// An unfinished film to resume, or null. It must have sums and this job's window and settings.
  const Film* unfinished = nullptr;
};

/// Renders an image. Several renders can share a prepared scene, also concurrently. No bit of the
/// film depends on the intersector or the number of threads. The film of a window has the bits of
/// that part of the whole frame. A resumed film keeps its sums until it is complete, so it can be
/// resumed again. Rethrows exceptions of intersectors. A scene without lights is black except with
/// kPrimary: see default_lights.
[[nodiscard]] Film render(const RenderJob& job, const IntersectorFactory& make_intersector,
                          RenderStats& stats, const RenderMonitor& monitor = {});

}  // namespace raygate
