// Default lights: for scenes without any.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/scene/scene.h"

namespace raygate {

/// They stand in place of the scene's point lights and background.
struct CameraLights {
  std::vector<PointLight> points;
  glm::vec3 background{0.0f};
  /// What mirrors and light from all around show in place of the background, which the camera
  /// sees; of the same mean radiance.
  std::optional<EnvironmentMap> studio{};
  /// Of balls in place of the points, which are beyond the scene: their shadows are soft.
  double radius = 0.0;
};

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
