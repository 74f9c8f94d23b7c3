// libFuzzer target: renders arbitrary bytes as an OBJ file; bytes after the first 0x1E are s.mtl.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "host/base/input_error.h"
#include "host/render/fuzz/draw.h"
#include "host/scene/io/scene_loader.h"

namespace {

void write(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    const auto path =
        std::filesystem::temp_directory_path() / ("raygate_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    return path;
  }();
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t split = std::min(bytes.find('\x1E'), size);
  write(folder / "s.obj", bytes.substr(0, split));
  write(folder / "s.mtl", split < size ? bytes.substr(split + 1) : std::string_view());
  try {
    // Every scene that is read must also render.
    raygate::test::draw(raygate::load_obj(folder / "s.obj"));
  } catch (const raygate::InputError&) {
    // Expected for invalid files.
  }
  return 0;
}
