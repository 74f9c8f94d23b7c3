// Default lights: for scenes without any.
#pragma once

#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// Adds light to a scene that has none (no lights, no face that emits, no background): one light to
/// the upper left of the camera, or at the camera where that stands within the scene, and a dim
/// sky.
void add_default_lights(Scene& scene, const Camera& camera);

/// The same for a first look, whose camera nobody chose: with a second, weaker light from the
/// right, and also where all the light there is is a background, or faces that glow but light
/// nothing. Returns whether it did.
bool add_preview_lights(Scene& scene, const Camera& camera);

}  // namespace raygate
