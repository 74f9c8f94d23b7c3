// Lights that go with a camera.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace raygate {

/// They stand in place of the scene's point lights and background.
struct CameraLights {
  std::vector<PointLight> points;
  glm::vec3 background{0.0f};
};

}  // namespace raygate
