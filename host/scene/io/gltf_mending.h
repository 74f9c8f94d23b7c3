// Optional parts of a glTF file that tinygltf would refuse the whole file for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// Returns the JSON of a glTF file with stand-ins for images, cameras, lights, skins, sparse
/// elements and members of materials that tinygltf refuses. A stand-in has no picture, direction
/// or element, so that the reader leaves it out where it is used, as it does with other bad parts.
/// Appends a warning, perhaps repeatedly, about parts that are left out or changed here. Returns
/// text that is no JSON object as it is.
[[nodiscard]] std::string mend_gltf(std::string_view json, std::vector<std::string>& warnings);

}  // namespace raygate
