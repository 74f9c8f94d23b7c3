// Loads the scene of a picture or of a table of rays, for all programs and the Python module, and
// chooses the camera of a picture, with its default lights and ground.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "host/light/lights.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads the model, instances and lights of a scene file, and an environment map. The map's up
/// direction is `up` or, by default, the scene file's or the format's usual one. Throws InputError
/// as load_scene() and load_environment() do, and for too many triangles.
[[nodiscard]] Scene load(const SceneFile& file, const LoadOptions& options,
                         const EnvironmentSetting& environment = {},
                         const std::optional<glm::dvec3>& up = {});

/// A camera with its lights and ground.
struct Framing {
  Camera camera;
  std::optional<CameraLights> lights;  ///< default lights for a scene without lights
  bool has_ground;   ///< whether the picture has a ground that catches shadows, see add_ground()
  glm::dvec3 up;     ///< up direction of the view, for the ground
  std::string text;  ///< command-line options for the chosen view; "" if a camera was given
  CameraRequest request;  ///< request for the same framing; members without effect are unset
};

/// Chooses the first of: the requested camera, the scene's camera, a view of the whole scene.
/// Scenes without lights get default lights. A view of such a scene from above also gets a ground.
/// `aspect`: picture's width / height. Throws InputError as Camera::look_at and frame_scene do.
[[nodiscard]] Framing frame_picture(const CameraRequest& request, const Scene& scene,
                                    double aspect);

}  // namespace raygate
