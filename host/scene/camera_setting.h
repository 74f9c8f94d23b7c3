// Where a camera stands and looks, as a user or a file says it.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace raygate {

/// What is left out has a default.
struct CameraSetting {
  glm::dvec3 eye{0.0}, target{0.0};  ///< not the same point
  std::optional<glm::dvec3> up;      ///< upwards in the picture; not zero and not along the view
  std::optional<double> fov;         ///< from the lower to the upper edge in degrees, in (0, 180)
};

}  // namespace raygate
