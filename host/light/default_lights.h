// Default lights: for scenes without any.
#pragma once

#include <optional>

#include "host/light/camera_lights.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// Light for a scene that has none (no lights, no background, no face that emits but textures that
/// hardly light anything): one light to the upper left of the camera, with soft shadows, or at the
/// camera where that stands within the scene, and a dim sky. Nothing for other scenes.
[[nodiscard]] std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera);

/// The same for a first look, whose camera nobody chose: with a second, weaker light from the
/// right, and also where all the light there is is a background, or faces that
/// glow but light nothing.
[[nodiscard]] std::optional<CameraLights> preview_lights(const Scene& scene, const Camera& camera);

}  // namespace raygate
