#include "host/scene/io/scene_loader.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/io/text.h"

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
  const std::string ending = in_lower_case(file.extension().string());
  if (ending.empty()) return load_obj(file, options);
  for (const Kind& kind : kKinds) {
    if (ending == kind.ending) return kind.load(file, options);
  }
  throw InputError(file.string() + ": found a " + file.extension().string() +
                   " file, expected .obj, .glb, .gltf, .ply or .stl; Blender writes them by File > "
                   "Export > glTF 2.0 (with materials, lights and camera) or Wavefront");
}

std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               std::string_view name, const std::string& place,
                                               std::vector<std::string>& warnings) {
  const bool is_quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  std::string slashed(is_quoted ? name.substr(1, name.size() - 2) : name), plain(name);
  std::ranges::replace(slashed, '\\', '/');
  for (std::size_t at = 0; (at = plain.find("\\ ", at)) != plain.npos;) plain.erase(at, 1);
  std::error_code error;
  for (const std::string& spelling : {std::string(name), slashed, plain}) {
    std::filesystem::path file = folder / spelling;
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  const std::filesystem::path asked(slashed);
  const std::string wanted = in_lower_case(asked.filename().string());
  if (wanted.empty()) return std::nullopt;
  for (const std::filesystem::path& where : {folder / asked.parent_path(), folder}) {
    std::set<std::filesystem::path> found;
    for (std::filesystem::directory_iterator entry(where.empty() ? "." : where, error), end;
         !error && entry != end; entry.increment(error)) {
      const std::filesystem::path file = entry->path().filename();
      if (in_lower_case(file.string()) == wanted && entry->is_regular_file(error)) {
        found.insert(where / file);
      }
    }
    if (found.empty()) continue;
    warnings.push_back(place + in_quotes(name) + " is missing, " + found.begin()->string() +
                       " instead");
    return *found.begin();
  }
  return std::nullopt;
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

void load_textures(Scene& scene) {
  constexpr const char* kPlainInstead = ", its material is plain instead";
  std::map<std::pair<std::string, Texture::Content>, std::uint32_t> loaded;
  const auto load = [&](MaterialMap& map, Texture::Content content) {
    if (map.file.empty() || map.texture != kNoIndex) return;
    const auto [entry, is_new] = loaded.try_emplace(std::pair(map.file, content), kNoIndex);
    std::error_code ignored;
    if (is_new && !std::filesystem::is_regular_file(map.file, ignored)) {
      scene.warnings.push_back(map.file + ": the texture is missing" + kPlainInstead);
    } else if (is_new) {
      try {
        scene.textures.push_back(Texture::load(map.file, content));
        scene.files.emplace_back(map.file);
        entry->second = static_cast<std::uint32_t>(scene.textures.size() - 1);
      } catch (const InputError& error) {
        scene.warnings.push_back(std::string(error.what()) + kPlainInstead);
      }
    }
    map.texture = entry->second;
  };
  std::vector<bool> is_done(scene.materials.size());
  for (const Triangle& triangle : scene.triangles) {
    if (is_left_out(triangle) || is_done[triangle.material]) continue;
    is_done[triangle.material] = true;
    Material& material = scene.materials[triangle.material];
    MaterialMap& opacity = material.opacity_map;
    for_each_map(material, [&](MaterialMap& map) {
      load(map, &map == &opacity ? Texture::Content::kOpacity : Texture::Content::kColour);
    });
    if (opacity.texture != kNoIndex &&
        scene.textures[opacity.texture].min_code() >= material.opacity_cutoff) {
      opacity.texture = kNoIndex;  // hides nothing
    }
  }
}

}  // namespace raygate
