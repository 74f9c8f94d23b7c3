// PLY files, ASCII and binary, into a Scene.
#pragma once

#include <filesystem>

#include "host/scene/io/obj_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads the polygons of the element "face", in their order, as one object of a default material.
/// Of vertices x, y, z count, and where they are there nx, ny, nz. All other elements and
/// properties are read over; colours of vertices with a warning.
///
/// (No library that Debian 12 has reads PLY: assimp 5.2 crashed on damaged files, and keeps
/// positions as float alone, with which a scene far from its origin is lost.)
///
/// Throws InputError, with a line of what is text: what cannot be read or is no PLY 1.0, a file
/// that ends too soon, an index of no vertex, a number that is not finite, no face with an area.
[[nodiscard]] Scene load_ply(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace raygate
