// Lamps for scenes that have none.
#pragma once

#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// Adds light to a scene that has none (no lights, no face that emits, no background): one lamp to
/// the upper left of the camera, or at the camera where that stands within the scene, and a dim
/// sky.
void light_if_dark(Scene& scene, const Camera& camera);

/// The same for a first look, whose camera nobody chose: with a second, weaker lamp from the right,
/// and also where all the light there is is a background, or faces that glow but light nothing.
/// Returns whether it did.
bool light_first_look(Scene& scene, const Camera& camera);

}  // namespace raygate
