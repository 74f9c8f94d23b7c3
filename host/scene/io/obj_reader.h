// The statements of an OBJ file, each checked and handed on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/io/material_library.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/obj_chunk.h"
#include "host/scene/io/statement_reader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Numbers names in the order of their first use.
class NameTable {
 public:
  std::uint32_t number_of(const std::string& name) {
    const auto [entry, added] = numbers_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (added) names_.push_back(name);
    return entry->second;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

/// Reads v, vt, vn, f, g, o, s, usemtl and mtllib; vertices and faces part by part (see ObjChunk),
/// on several threads. Points, lines and free-form curves and surfaces are left out with a warning,
/// what only concerns a modeller without one; all else is an InputError. (B. Wavefront's "Object
/// Files", version 3.0, is the source of the statements.)
class ObjReader final : public StatementReader {
 public:
  ObjReader(const std::filesystem::path& file, MeshBuilder& mesh,
            std::vector<std::string>& warnings)
      : StatementReader(file, warnings), mesh_(mesh), mtl_(file.parent_path(), lines(), warnings) {}

  /// All statements. Faces go to the mesh with numbers for their material and object.
  void read(const LoadOptions& options);

  [[nodiscard]] const MaterialLibrary& mtl() const { return mtl_; }
  [[nodiscard]] const std::vector<std::string>& objects() const { return objects_.names(); }
  /// The names of usemtl, which faces have numbers of (kNoIndex: none); where each came first.
  [[nodiscard]] const std::vector<std::string>& materials() const { return materials_.names(); }
  [[nodiscard]] const std::vector<std::string>& material_places() const { return places_; }

 private:
  void take(ObjChunk& part);
  void assign_faces(std::size_t begin, std::size_t end);
  void read_statement(std::string_view statement);
  void use_material(const std::string& name);
  void set_group(std::string_view names);
  void set_smoothing(std::string_view words);

  MeshBuilder& mesh_;
  MaterialLibrary mtl_;
  NameTable objects_, materials_;
  std::vector<std::string> places_;  // "file:line: " of the first use of each material
  std::string object_, group_;       // in force; empty: none
  std::uint32_t object_number_ = 0;
  bool object_is_known_ = false;
  std::uint32_t material_number_ = kNoIndex;
  std::uint32_t smoothing_group_ = 0;
};

}  // namespace raygate
