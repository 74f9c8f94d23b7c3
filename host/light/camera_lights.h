// Lights that belong to a camera.
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

}  // namespace raygate
