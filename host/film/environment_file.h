// Environment maps from files: OpenEXR and Radiance HDR.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace raygate {

/// Linear RGB, row by row from the top.
struct HdrImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< finite, none negative
};

/// Reads a picture of 32-bit RGBE, run-length encoded or not, whose rows go from left to right and
/// from the top down (Ward, "Real pixels", 1991; the format's page at radsite.lbl.gov). Its
/// EXPOSURE lines are taken back. Throws InputError: what cannot be read or is none, is damaged, or
/// is larger than 2^26 pixels.
[[nodiscard]] HdrImage read_hdr(const std::filesystem::path& file);

/// Reads the map into scene.environment; `up` is upwards in the scene, not zero. Its middle is
/// ahead: towards -z where +y is up, towards +y where +z is. OpenEXR (channels R, G, B) or Radiance
/// HDR, as its first bytes say. What is negative or no number counts as 0, what is above 1e30 as
/// that. Throws InputError as read_exr and read_hdr.
void load_environment(const EnvironmentSetting& setting, const glm::dvec3& up, Scene& scene);

}  // namespace raygate
