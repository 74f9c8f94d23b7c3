// Radiance HDR pictures (.hdr, .pic), for environment maps.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

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

}  // namespace raygate
