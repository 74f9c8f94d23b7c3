// Where nodes of a glTF file are, and where they have their meshes.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/io/instance_settings.h"

namespace raygate {

/// From a node's coordinates to its parent's.
[[nodiscard]] glm::dmat4 local_matrix(const tinygltf::Node& node);

/// Where a node has its mesh, in its own coordinates: once, or as EXT_mesh_gpu_instancing says.
/// Throws InputError: attributes that are none, or not as many of each.
[[nodiscard]] std::vector<glm::dmat4> places_in(const GltfFile& file, const tinygltf::Node& node);

[[nodiscard]] TransformRows rows_of(const glm::dmat4& matrix);

}  // namespace raygate
