// Default lights: for scenes without any.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/light/lights.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// Returns lights for a scene without any (no lights, no background, and no emission except
/// textures that hardly light anything): a light to the upper left of the camera with soft shadows,
/// or at the camera if that is inside the scene, and a dim sky. Returns nullopt for other scenes.
[[nodiscard]] std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera);

/// Returns lights for a preview, whose camera the user did not choose: as above, with a second,
/// weaker light from the right, and also for scenes lit only by a background or by faces whose
/// emission lights nothing.
[[nodiscard]] std::optional<CameraLights> preview_lights(const Scene& scene, const Camera& camera);

}  // namespace raygate
