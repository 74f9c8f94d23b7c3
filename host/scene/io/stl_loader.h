// STL files, binary and ASCII, into a Scene.
#pragma once

#include <filesystem>

#include "host/scene/io/obj_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Loads triangles in their order, as one object of a default material; +z is up, as STL files
/// mostly have it. Normals, colours and attributes in the file count for nothing.
///
/// Throws InputError, with a line where the file is text: what cannot be read or is no STL, a file
/// that ends too soon, a number that is not finite, no facet with an area.
[[nodiscard]] Scene load_stl(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace raygate
