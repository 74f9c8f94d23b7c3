#include "host/scene/io/mtl_loader.h"

#include <algorithm>
#include <istream>

#include "host/scene/io/mtl_text.h"
#include "host/scene/io/words.h"

namespace raygate {
namespace {

glm::vec3 colour(const tinyobj::real_t (&rgb)[3]) { return glm::vec3(rgb[0], rgb[1], rgb[2]); }

// Files made on Windows name folders with backslashes.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               std::string_view name) {
  std::string slashed(name);
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  for (const std::string& spelling : {std::string(name), slashed}) {
    std::error_code ignored;
    std::filesystem::path file = folder / spelling;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

Material converted(const tinyobj::material_t& read, const std::filesystem::path& folder) {
  Material material;
  material.name = read.name;
  material.diffuse = colour(read.diffuse);
  material.specular = colour(read.specular);
  material.emission = colour(read.emission);
  material.transmittance = colour(read.transmittance);
  material.shininess = static_cast<float>(read.shininess);
  material.refraction_index = static_cast<float>(read.ior);
  material.opacity = static_cast<float>(read.dissolve);
  material.illumination_model = read.illum;
  if (!read.diffuse_texname.empty()) {
    material.diffuse_map =
        find_file(folder, read.diffuse_texname).value_or(folder / read.diffuse_texname).string();
    const tinyobj::texture_option_t& options = read.diffuse_texopt;
    material.diffuse_mapping.scale = glm::vec2(options.scale[0], options.scale[1]);
    material.diffuse_mapping.offset = glm::vec2(options.origin_offset[0], options.origin_offset[1]);
    material.diffuse_mapping.clamp = options.clamp;
  }
  return material;
}

}  // namespace

bool MtlLoader::operator()(const std::string& names, std::vector<tinyobj::material_t>*,
                           std::map<std::string, int>*, std::string*, std::string*) {
  std::string_view rest = names;
  if (rest.empty()) warnings_.push_back(obj_.place() + "mtllib without a file");
  std::optional<std::filesystem::path> file = find_file(folder_, rest);
  if (file) {
    load(*file);
    return true;
  }
  for (std::string_view name = take_word(rest); !name.empty(); name = take_word(rest)) {
    file = find_file(folder_, name);
    if (file) {
      load(*file);
    } else {
      warnings_.push_back(obj_.place() + "material file " + in_quotes(name) +
                          " is missing, default materials instead");
    }
  }
  return true;
}

void MtlLoader::load(const std::filesystem::path& file) {
  if (!loaded_.insert(file.lexically_normal()).second) return;
  MtlText text(file, warnings_);
  std::istream stream(&text);
  stream.exceptions(std::ios::badbit);
  tinyobj::LoadMtl(&index_of_name_, &read_, &stream, nullptr, nullptr);
  // The library ends each file with one more material, nameless if there was no newmtl.
  if (read_.back().name.empty()) {
    read_.pop_back();
    warnings_.push_back(file.string() + ": defines no material");
  }
  for (std::size_t i = materials_.size(); i < read_.size(); ++i) {
    materials_.push_back(converted(read_[i], file.parent_path()));
  }
}

std::optional<std::uint32_t> MtlLoader::find(const std::string& name) const {
  const auto found = index_of_name_.find(name);
  if (name.empty() || found == index_of_name_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found->second);
}

}  // namespace raygate
