// The camera of a glTF file.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Gives a scene that has none yet the camera of a node that is at `world`, with a target
/// ahead. Warns and leaves it out: one without a direction, a second one. Throws InputError: an
/// impossible angle or size.
void read_camera(const GltfFile& file, const tinygltf::Camera& camera, const glm::dmat4& world,
                 Scene& scene);

/// Moves the target of a scene's camera, if it has one, along the view to the middle of the scene,
/// which is whole by now; the picture stays as large.
void aim_camera(Scene& scene);

}  // namespace raygate
