// The materials of a scene: MTL files by the library, found by name.
#pragma once

#include <tiny_obj_loader.h>

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

/// Called by the library for each mtllib statement of the OBJ file that it reads.
class MtlLoader final : public tinyobj::MaterialReader {
 public:
  /// MTL files are looked for in `folder`. `obj` says where the OBJ file is being read. Both
  /// references must outlive this.
  MtlLoader(std::filesystem::path folder, const TextLines& obj, std::vector<std::string>& warnings)
      : folder_(std::move(folder)), obj_(obj), warnings_(warnings) {}

  /// Loads `names`: one file whose name may hold spaces, or several files with spaces between.
  /// Warns of one that is missing, throws InputError for one that is wrong. The library's own
  /// lists stay empty, for its map of names could not find what a later mtllib brings.
  bool operator()(const std::string& names, std::vector<tinyobj::material_t>*,
                  std::map<std::string, int>*, std::string*, std::string*) override;

  /// Index into materials() of the first material with this name.
  [[nodiscard]] std::optional<std::uint32_t> find(const std::string& name) const;
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

 private:
  void load(const std::filesystem::path& file);  // once each

  std::filesystem::path folder_;
  const TextLines& obj_;
  std::vector<std::string>& warnings_;
  std::set<std::filesystem::path> loaded_;
  std::map<std::string, int> index_of_name_;
  std::vector<tinyobj::material_t> read_;
  std::vector<Material> materials_;  // read_, as the scene has them
};

}  // namespace raygate
