#include <charconv>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/threads.h"
#include "host/scene/io/material_library.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/obj_chunk.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/text_lines.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

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

/// Reads v, vt, vn, f, g, o, s, usemtl and mtllib; vertices and faces on several threads (see
/// ObjChunk). Leaves out points, lines and free-form curves and surfaces, with a warning, and
/// statements that only concern a modelling program, without one. Throws InputError for any other
/// statement. (The statements are those of Wavefront's "Object Files", version 3.0.)
class ObjReader final : public StatementReader {
 public:
  ObjReader(const std::filesystem::path& file, Scene& scene)
      : StatementReader(file, scene.warnings),
        mesh_(file.string()),
        mtl_(file.parent_path(), lines(), scene.warnings),
        scene_(scene) {}

  void read(const LoadOptions& options) {
    read_statements(options);
    mesh_.build(options, scene_);
    scene_.objects = NameList(objects_.names());
    scene_.files = {mtl_.files().begin(), mtl_.files().end()};
    scene_.files.emplace_back(lines().file_name());
    assign_materials();
    if (options.textures) load_textures(scene_);
  }

 private:
  // Counts lines and vertices first, for the line numbers and negative indices of chunks.
  void read_statements(const LoadOptions& options) {
    const std::size_t most = options.threads > 1 ? std::size_t{4} * options.threads : 1;
    std::vector<ObjChunk> chunks;
    for (TextLines& chunk : lines().split(most, options.chunk_size)) {
      chunks.emplace_back(std::move(chunk));
    }
    if (chunks.size() > 1) {
      std::vector<ObjChunk::Counts> counts(chunks.size());
      for_each_on_threads(options.threads, chunks.size(),
                          [&](std::size_t i) { counts[i] = chunks[i].count(); });
      ObjChunk::Counts before;
      for (std::size_t i = 0; i < chunks.size(); ++i) {
        chunks[i].begin_after(before);
        before.lines += counts[i].lines;
        before.mesh += counts[i].mesh;
      }
    }
    for_each_on_threads(options.threads, chunks.size(), [&](std::size_t i) { chunks[i].read(); });
    for (ObjChunk& chunk : chunks) take(chunk);
  }

  void take(ObjChunk& chunk) {
    const std::size_t first = mesh_.face_count();
    std::size_t done = first;
    mesh_.append(std::move(chunk.mesh()));
    for (const ObjChunk::Rest& rest : chunk.rest()) {
      assign_faces(done, first + rest.faces);
      done = first + rest.faces;
      lines().go_to(rest.line);
      read_statement(rest.statement);
    }
    assign_faces(done, mesh_.face_count());
    chunk.rethrow();
  }

  /// Sets the material and the object of the faces in [begin, end) to the current ones.
  void assign_faces(std::size_t begin, std::size_t end) {
    if (begin == end) return;
    if (!object_is_known_) {
      const std::string between = object_.empty() || group_.empty() ? "" : "/";
      const std::string name = object_ + between + group_;
      object_number_ = objects_.number_of(name.empty() ? "default" : name);
      object_is_known_ = true;
    }
    mesh_.assign_faces(begin, end, material_number_, object_number_, smoothing_group_);
  }

  void read_statement(std::string_view statement) {
    const std::string_view keyword = take_token(statement);
    if (keyword == "g") {
      set_group(statement);
    } else if (keyword == "o") {
      object_ = statement;
      object_is_known_ = false;
    } else if (keyword == "s") {
      set_smoothing(statement);
    } else if (keyword == "usemtl") {
      material_number_ = materials_.number_of(std::string(statement));
      if (material_number_ == first_uses_.size()) first_uses_.push_back(lines().place());
    } else if (keyword == "mtllib") {
      mtl_.load_library(statement);
    } else if (keyword == "v") {
      warn_once(keyword, "vertex weights are ignored: they concern curves alone");
    } else {
      warn_once(keyword,
                std::string(keyword) + " statements are ignored: only polygons are rendered");
    }
  }

  /// Sets the group. "a b" may be one name or two; it is taken as one.
  void set_group(std::string_view names) {
    group_.clear();
    for (std::string_view name = take_token(names); !name.empty(); name = take_token(names)) {
      group_.append(group_.empty() ? "" : " ").append(name);
    }
    object_is_known_ = false;
  }

  void set_smoothing(std::string_view words) {
    mesh_.smoothing_is_said();
    const std::string_view word = take_token_before_comment(words);
    const char* const end = word.data() + word.size();
    smoothing_group_ = 0;
    const auto [rest, error] = std::from_chars(word.data(), end, smoothing_group_);
    if (word == "off" || (error == std::errc() && rest == end)) return;
    smoothing_group_ = word == "on" ? 1 : 0;
    if (word != "on") {
      warn_once("s",
                "s " + in_quotes(word) + ", expected the number of a group or off; taken as off");
    }
  }

  /// Resolves the names of materials at the end of the file, as mtllib may come after usemtl.
  void assign_materials() {
    scene_.materials = mtl_.materials();
    // Scanners duplicate the texture's colours at the vertices.
    for (Material& material : scene_.materials) {
      material.has_vertex_colors = material.diffuse_map.empty();
    }
    std::uint32_t default_material = kNoIndex;
    std::vector<std::uint32_t> materials;
    const std::vector<std::string>& names = materials_.names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      materials.push_back(mtl_.find(names[i]).value_or(kNoIndex));
      if (materials[i] == kNoIndex && !names[i].empty()) {
        scene_.warnings.push_back(first_uses_[i] + "material " + in_quotes(names[i]) +
                                  " is defined nowhere, the default instead");
      }
    }
    for (Triangle& triangle : scene_.triangles) {
      if (triangle.material != kNoIndex) triangle.material = materials[triangle.material];
      if (triangle.material != kNoIndex) continue;
      if (default_material == kNoIndex) {
        default_material = static_cast<std::uint32_t>(scene_.materials.size());
        Material& material = scene_.materials.emplace_back();
        material.name = "default";
        if (!scene_.colors.empty()) material.diffuse = glm::vec3(1.0f);
      }
      triangle.material = default_material;
    }
  }

  MeshBuilder mesh_;
  MaterialLibrary mtl_;
  Scene& scene_;
  NameTable objects_;
  NameTable materials_;                  // of usemtl; faces store their indices (kNoIndex: none)
  std::vector<std::string> first_uses_;  // "file:line: " of the first use of each material
  std::string object_, group_;           // the current ones; empty: none
  std::uint32_t object_number_ = 0;
  bool object_is_known_ = false;
  std::uint32_t material_number_ = kNoIndex;
  std::uint32_t smoothing_group_ = 0;
};

}  // namespace

Scene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
  Scene scene;
  ObjReader(file, scene).read(options);
  return scene;
}

}  // namespace raygate
