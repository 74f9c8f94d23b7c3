// Files of any kind that is read, into a Scene.
#pragma once

#include <filesystem>

#include "host/scene/io/obj_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads `file` as what its name ends in: .obj (or nothing), .gltf, .glb, .ply or .stl, in small or
/// capital letters. Throws InputError for any other ending, with what to do about it, and as the
/// loaders do.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

/// The file of this stem that is there, by the first of those endings: "room" gives "room.obj",
/// also where there is none.
[[nodiscard]] std::filesystem::path find_scene_file(const std::filesystem::path& stem);

}  // namespace raygate
