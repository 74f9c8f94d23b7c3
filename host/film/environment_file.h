// Environment maps from files: OpenEXR and Radiance HDR.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// Reads a Radiance picture with 32-bit RGBE pixels in standard orientation (Ward, "Real pixels",
/// 1991): flat, or run-length encoded by component. The older runs of whole pixels are not
/// supported. Pixels are divided by EXPOSURE. Throws InputError if the file cannot be read, is not
/// such a picture, is damaged, or has more than 2^26 pixels.
[[nodiscard]] EnvironmentMap read_hdr(const std::filesystem::path& file);

/// Reads an environment map: OpenEXR (channels R, G, B) or Radiance HDR, by its first bytes. `up`:
/// not zero. The centre of the map points towards -z if +y is up, towards +y if +z is up. Negative
/// values and NaN become 0; values are limited to 1e30. Throws InputError, see read_exr, read_hdr.
void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene);

}  // namespace raygate
