// glTF 2.0 files (.gltf and .glb) into a Scene.
#pragma once

#include <filesystem>

#include "host/scene/io/obj_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads the file's scene: triangles, strips and fans of all nodes, each where its node puts it, in
/// the order of the nodes, an object for each; materials as GltfMaterials says; the first
/// perspective camera; point lights (KHR_lights_punctual: 683 candela are 1 watt per steradian),
/// with lights from one direction as point lights far away, and spot lights as point lights. +y is
/// up. Positions are transformed in double. Skins, morph targets and animations are left as they
/// are at rest.
///
/// Throws InputError: what GltfFile refuses, an index or a length beyond what there is, a number
/// that is not finite, a node with two parents, more than 12 million vertices and corners of faces,
/// and as many again as there are bytes, after all instances are written out; no face with an area.
[[nodiscard]] Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace raygate
