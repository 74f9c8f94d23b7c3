#include "host/scene/io/scene_loader.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

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

namespace {

constexpr const char* kPlainInstead = ", its material is plain instead";

class TextureLoader {
 public:
  explicit TextureLoader(Scene& scene) : scene_(scene) {}

  void load_all(Material& material) {
    if (material.diffuse_texture == kNoIndex) {
      material.diffuse_texture = number_of(material.diffuse_map, Texture::Content::kColour);
    }
    load(material.normal_map, Texture::Content::kColour);
    load(material.emission_map, Texture::Content::kColour);
    load(material.opacity_map, Texture::Content::kOpacity);
    if (material.opacity_map.texture != kNoIndex &&
        scene_.textures[material.opacity_map.texture].min_code() >= material.opacity_cutoff) {
      material.opacity_map.texture = kNoIndex;
    }
    if (material.metallic_roughness) load_pair(*material.metallic_roughness);
  }

 private:
  void load(MaterialMap& map, Texture::Content content) {
    if (map.texture == kNoIndex) map.texture = number_of(map.file, content);
  }

  /// Combines the textures: roughness is the green channel, metalness the blue one.
  void load_pair(MetallicRoughness& shares) {
    if (shares.map.texture != kNoIndex) return;
    const std::uint32_t rough = number_of(shares.map.file, Texture::Content::kColour);
    const std::uint32_t metal = number_of(shares.metallic_file, Texture::Content::kColour);
    if (rough == kNoIndex && metal == kNoIndex) return;
    const auto [entry, is_new] = pairs_.try_emplace(std::pair(rough, metal), kNoIndex);
    if (is_new) {
      const auto texture = [&](std::uint32_t number) {
        return number == kNoIndex ? nullptr : &scene_.textures[number];
      };
      Texture both = Texture::combine_channels(texture(rough), texture(metal));
      entry->second = static_cast<std::uint32_t>(scene_.textures.size());
      scene_.textures.push_back(std::move(both));
    }
    shares.map.texture = entry->second;
  }

  std::uint32_t number_of(const std::string& file, Texture::Content content) {
    if (file.empty()) return kNoIndex;
    const auto [entry, is_new] = loaded_.try_emplace(std::pair(file, content), kNoIndex);
    std::error_code ignored;
    if (is_new && !std::filesystem::is_regular_file(file, ignored)) {
      scene_.warnings.push_back(file + ": the texture is missing" + kPlainInstead);
    } else if (is_new) {
      try {
        scene_.textures.push_back(Texture::load(file, content));
        scene_.files.emplace_back(file);
        entry->second = static_cast<std::uint32_t>(scene_.textures.size() - 1);
      } catch (const InputError& error) {
        scene_.warnings.push_back(std::string(error.what()) + kPlainInstead);
      }
    }
    return entry->second;
  }

  Scene& scene_;
  std::map<std::pair<std::string, Texture::Content>, std::uint32_t> loaded_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> pairs_;
};

}  // namespace

void load_textures(Scene& scene) {
  TextureLoader loader(scene);
  std::vector<bool> is_done(scene.materials.size());
  for (const Triangle& triangle : scene.triangles) {
    if (is_left_out(triangle) || is_done[triangle.material]) continue;
    is_done[triangle.material] = true;
    loader.load_all(scene.materials[triangle.material]);
  }
}

}  // namespace raygate
