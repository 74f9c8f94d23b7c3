#include "host/scene/io/material_library.h"

#include <utility>

#include "host/scene/io/mtl_reader.h"
#include "host/scene/io/tokens.h"

namespace raygate {

void MaterialLibrary::load_library(std::string_view names) {
  if (names.empty()) {
    warnings_.push_back(obj_.place() + "mtllib without a file");
    return;
  }
  if (const auto file = find_file(folder_, names)) return load(*file);
  for (std::string_view name = take_token(names); !name.empty(); name = take_token(names)) {
    if (const auto file = find_file(folder_, name)) {
      load(*file);
    } else {
      warnings_.push_back(obj_.place() + "material file " + in_quotes(name) +
                          " is missing, default materials instead");
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

}  // namespace raygate
