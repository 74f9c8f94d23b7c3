// The materials of an OBJ file, by name, from the MTL files that it names; and their textures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/text_lines.h"
#include "host/scene/scene.h"

namespace raygate {

class MaterialLibrary {
 public:
  /// MTL files are looked for in `folder`. `obj` says where the OBJ file is being read. Both
  /// references must outlive this.
  MaterialLibrary(std::filesystem::path folder, const TextLines& obj,
                  std::vector<std::string>& warnings)
      : folder_(std::move(folder)), obj_(obj), warnings_(warnings) {}

  /// Loads what a mtllib statement names: one file whose name may hold spaces, or several files
  /// with spaces between, as find_file does. Warns of one that is missing, throws InputError for
  /// one that is wrong.
  void load_library(std::string_view names);

  /// Index into materials() of the first material with this name.
  [[nodiscard]] std::optional<std::uint32_t> find(const std::string& name) const;
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
  /// The files that were read.
  [[nodiscard]] const std::set<std::filesystem::path>& files() const { return loaded_; }

 private:
  void load(const std::filesystem::path& file);  // once each

  std::filesystem::path folder_;
  const TextLines& obj_;
  std::vector<std::string>& warnings_;
  std::set<std::filesystem::path> loaded_;
  std::map<std::string, std::uint32_t> index_of_name_;
  std::vector<Material> materials_;
};

/// Loads the textures that materials of triangles name by files, each file once for each use;
/// fills Scene::textures and the materials' indices. Pictures of roughness and of metalness
/// become one. Masks that hide nothing are left out. Warns of a file that is missing or that
/// Texture::load refuses.
void load_textures(Scene& scene);

}  // namespace raygate
