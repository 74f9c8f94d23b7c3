#include "host/scene/io/scene_loader.h"

#include <string>

#include "host/base/input_error.h"

namespace raygate {
namespace {

struct Kind {
  const char* ending;
  Scene (*load)(const std::filesystem::path&, const LoadOptions&);
};
constexpr Kind kKinds[] = {{".obj", load_obj},
                           {".glb", load_gltf},
                           {".gltf", load_gltf},
                           {".ply", load_ply},
                           {".stl", load_stl}};

}  // namespace

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  std::string ending = file.extension().string();
  for (char& letter : ending) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  if (ending.empty()) return load_obj(file, options);
  for (const Kind& kind : kKinds) {
    if (ending == kind.ending) return kind.load(file, options);
  }
  throw InputError(file.string() + ": found a " + file.extension().string() +
                   " file, expected .obj, .glb, .gltf, .ply or .stl; Blender writes them by File > "
                   "Export > glTF 2.0 (with materials, lights and camera) or Wavefront");
}

std::filesystem::path find_scene_file(const std::filesystem::path& stem) {
  std::filesystem::path file;
  for (const Kind& kind : kKinds) {
    std::error_code ignored;
    file = stem.string() + kind.ending;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return stem.string() + kKinds[0].ending;
}

}  // namespace raygate
