// Loading the scene of a picture or a table of rays, as all programs and the Python module do.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/scene/io/scene_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads the model, instances and lights of a scene file, and an environment map whose up direction
/// is `up`, else the file's, else the format's usual one. Throws InputError as load_scene() and
/// load_environment() do, and if the scene has too many triangles or objects to number.
[[nodiscard]] Scene load(const SceneFile& file, const LoadOptions& options,
                         const std::optional<EnvironmentSetting>& environment = {},
                         const std::optional<glm::dvec3>& up = {});

}  // namespace raygate
