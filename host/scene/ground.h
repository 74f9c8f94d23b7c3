// A ground for scenes that stand nowhere.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// Adds a square of two triangles under the scene, a hair below its lowest point and 32 times its
/// size, of an object and a material of its own, "ground": it catches shadows (illum 10) and is
/// else not to be seen. `up` is not zero. A scene too large for that is left as it is.
void add_ground(Scene& scene, const glm::dvec3& up);

}  // namespace raygate
