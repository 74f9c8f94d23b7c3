// Default lights: for scenes without any.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/scene/scene.h"

namespace raygate {

/// Lights that belong to a camera. They replace the scene's point lights and background.
struct CameraLights {
  std::vector<PointLight> points;
  glm::vec3 background{0.0f};
  /// Environment that lights the scene and is seen in mirrors in place of the background, which
  /// only the camera sees; it has the same mean radiance.
  std::optional<EnvironmentMap> studio{};
  /// Radius of spheres that replace the points, for soft shadows; they are outside the scene.
  double radius = 0.0;
};

class Camera;

/// Returns lights for a scene that has none (no lights, no background, no emission except textures
/// that hardly light anything): one light to the upper left of the camera with soft shadows, or at
/// the camera if that is inside the scene, and a dim sky. Returns nothing for other scenes.
[[nodiscard]] std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera);

/// Returns lights for a preview, whose camera the user did not choose: as above, with a second,
/// weaker light from the right, and also for scenes lit only by a background or by faces whose
/// emission lights nothing.
[[nodiscard]] std::optional<CameraLights> preview_lights(const Scene& scene, const Camera& camera);

}  // namespace raygate
