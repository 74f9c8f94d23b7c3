#include "host/scene/io/material_library.h"

#include <algorithm>
#include <map>
#include <utility>

#include "host/base/input_error.h"
#include "host/scene/io/find_file.h"
#include "host/scene/io/mtl_reader.h"
#include "host/scene/io/tokens.h"

namespace raygate {

void MaterialLibrary::load_library(std::string_view names) {
  if (names.empty()) {
    warnings_.push_back(obj_.place() + "mtllib without a file");
    return;
  }
  std::vector<std::string_view> words;
  std::string_view rest = names;
  while (!rest.empty()) {
    const std::size_t end = rest.starts_with('"') ? rest.find('"', 1) : rest.npos;
    words.push_back(rest.substr(0, end == rest.npos ? rest.find_first_of(" \t") : end + 1));
    rest.remove_prefix(words.back().size());
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  }
  // One name may have several words, also if its file has another spelling here.
  const bool are_several = std::ranges::all_of(
      words, [&](std::string_view name) { return find_exact_file(folder_, name).has_value(); });
  if (!are_several || find_exact_file(folder_, names)) {
    if (const auto file = find_file(folder_, names, obj_.place(), warnings_)) return load(*file);
  }
  for (const std::string_view name : words) {
    if (const auto file = find_file(folder_, name, obj_.place(), warnings_)) {
      load(*file);
    } else {
      std::error_code error;
      const bool is_known =
          std::filesystem::status(folder_ / name, error).type() != std::filesystem::file_type::none;
      warnings_.push_back(obj_.place() + "material file " + in_quotes(name) +
                          (is_known ? " is missing" : " cannot be read: " + error.message()) +
                          ", default materials instead");
    }
  }
}

void MaterialLibrary::load(const std::filesystem::path& file) {
  if (!loaded_.insert(file.lexically_normal()).second) return;
  std::vector<Material> read = MtlReader(file, warnings_).read();
  if (read.empty()) warnings_.push_back(file.string() + ": defines no material");
  for (Material& material : read) {
    index_of_name_.emplace(material.name, static_cast<std::uint32_t>(materials_.size()));
    materials_.push_back(std::move(material));
  }
}

std::optional<std::uint32_t> MaterialLibrary::find(const std::string& name) const {
  const auto found = index_of_name_.find(name);
  if (found == index_of_name_.end()) return std::nullopt;
  return found->second;
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
