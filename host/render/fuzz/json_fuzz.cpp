// libFuzzer target: renders arbitrary bytes as a scene file next to a model, "model.obj".
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "host/base/input_error.h"
#include "host/render/fuzz/draw.h"
#include "host/scene/io/scene_loader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    auto path =
        std::filesystem::temp_directory_path() / ("raygate_fuzz_" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    std::ofstream(path / "model.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";
    return path;
  }();
  const std::filesystem::path file = folder / "model.json";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const raygate::SceneFile read = raygate::read_scene_file(file);
    raygate::Scene scene = raygate::load_scene(read);
    raygate::test::draw(scene);
  } catch (const raygate::InputError&) {
    // Expected for invalid files.
  }
  return 0;
}
