// Lights that go with a camera.
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

}  // namespace raygate
