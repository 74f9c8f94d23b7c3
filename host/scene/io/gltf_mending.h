// Repairs optional parts of a glTF file for which tinygltf would refuse the whole file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// Returns the JSON of a glTF file with placeholders for images, cameras, lights, skins, sparse
/// elements and members of materials that tinygltf refuses. A placeholder is empty, so the loader
/// skips it, as it does other bad parts. Appends a warning, possibly repeatedly, for each part that
/// is changed. Returns text that is not a JSON object unchanged.
[[nodiscard]] std::string mend_gltf(std::string_view json, std::vector<std::string>& warnings);

}  // namespace raygate
