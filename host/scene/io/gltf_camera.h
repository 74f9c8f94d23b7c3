// The camera of a glTF file.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Gives a scene that has none yet the camera of a node that is at `world`, one length ahead its
/// target. Warns and leaves it out: an orthographic one, one without a direction, a second one.
/// Throws InputError: an impossible angle.
void read_camera(const GltfFile& file, const tinygltf::Camera& camera, const glm::dmat4& world,
                 Scene& scene);

/// Moves the target of a scene's camera, if it has one, along the view to the middle of the scene,
/// which is whole by now.
void aim_camera(Scene& scene);

}  // namespace raygate
