// MaterialLibrary: the materials of an OBJ file, from its MTL files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/scene/io/text.h"
#include "host/scene/scene.h"

namespace raygate {

class MaterialLibrary {
 public:
  /// Searches for MTL files in `folder`. `warnings` must outlive this object.
  MaterialLibrary(std::filesystem::path folder, std::vector<std::string>& warnings)
      : folder_(std::move(folder)), warnings_(warnings) {}

  /// Loads the files that a mtllib statement names: one file whose name may hold spaces, or several
  /// names, separated by spaces, some perhaps in quotes. Warns about a file that is missing. Throws
  /// InputError for a file with an error.
  void load_library(const Words& names);

  /// Returns the index in materials() of the first material with this name.
  [[nodiscard]] std::optional<std::uint32_t> find(const std::string& name) const;
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
  /// Returns the paths of the files that were read.
  [[nodiscard]] const std::set<std::filesystem::path>& files() const { return loaded_; }

 private:
  void load(const std::filesystem::path& file);  // once each

  std::filesystem::path folder_;
  std::vector<std::string>& warnings_;
  std::set<std::filesystem::path> loaded_;
  std::map<std::string, std::uint32_t> index_of_name_;
  std::vector<Material> materials_;
};

}  // namespace raygate
