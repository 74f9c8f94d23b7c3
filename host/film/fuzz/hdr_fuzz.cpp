// libFuzzer target: arbitrary bytes as a Radiance image.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "host/base/input_error.h"
#include "host/film/environment_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                            ("raygate_fuzz_" + std::to_string(getpid()) + ".hdr");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    for (const glm::vec3& pixel : raygate::read_hdr(file).texels) {
      for (int k = 0; k < 3; ++k) {
        if (!(std::isfinite(pixel[k]) && pixel[k] >= 0.0f)) std::abort();
      }
    }
  } catch (const raygate::InputError&) {
    // Expected for invalid files.
  }
  return 0;
}
