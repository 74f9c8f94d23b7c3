// Environment maps from files.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// Reads the map into scene.environment; `up` is upwards in the scene, not zero. Its middle is
/// ahead: towards -z where +y is up, towards +y where +z is. OpenEXR (channels R, G, B) or Radiance
/// HDR, as its first bytes say. What is negative or no number counts as 0, what is above 1e30 as
/// that. Throws InputError as read_exr and read_hdr.
void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene);

}  // namespace raygate
