// libFuzzer target: renders arbitrary bytes as a file with the ending in RAYGATE_FUZZED, as "ply".
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/base/input_error.h"
#include "host/render/fuzz/draw.h"
#include "host/scene/io/scene_loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("raygate_fuzz_" + std::to_string(getpid()) + "." RAYGATE_FUZZED);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    raygate::test::draw(raygate::load_scene(file));
  } catch (const raygate::InputError&) {
    // Expected for invalid files.
  }
  return 0;
}
