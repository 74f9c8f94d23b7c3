#include "host/scene/io/obj_loader.h"

#include <tiny_obj_loader.h>

#include <istream>
#include <map>

#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/mtl_loader.h"
#include "host/scene/io/obj_text.h"
#include "host/scene/io/words.h"

namespace raygate {
namespace {

// Numbers names in the order of their first use.
class NameTable {
 public:
  std::uint32_t number_of(const std::string& name) {
    const auto [entry, added] = numbers_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (added) names_.push_back(name);
    return entry->second;
  }
  [[nodiscard]] std::vector<std::string>& names() { return names_; }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

// What the library calls for each statement, and what is in force between them.
class ObjReader {
 public:
  ObjReader(const std::filesystem::path& file, const LoadOptions& options)
      : options_(options),
        text_(file, scene_.warnings),
        mtl_(file.parent_path(), text_.lines(), scene_.warnings),
        mesh_(file.string()) {}

  Scene read() {
    std::istream stream(&text_);
    stream.exceptions(std::ios::badbit);
    tinyobj::LoadObjWithCallback(stream, callbacks(), this, &mtl_);
    mesh_.build(options_, scene_);
    scene_.objects = std::move(objects_.names());
    give_materials();
    load_textures(scene_);
    return std::move(scene_);
  }

 private:
  static ObjReader& self(void* user_data) { return *static_cast<ObjReader*>(user_data); }

  // The library's numbers are passed over for those of ObjText, which are exact.
  static tinyobj::callback_t callbacks() {
    using tinyobj::real_t;
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* data, real_t, real_t, real_t, real_t) {
      const auto numbers = self(data).text_.numbers();
      self(data).mesh_.add_position({numbers[0], numbers[1], numbers[2]});
    };
    callbacks.normal_cb = [](void* data, real_t, real_t, real_t) {
      const auto numbers = self(data).text_.numbers();
      self(data).mesh_.add_normal({numbers[0], numbers[1], numbers[2]});
    };
    callbacks.texcoord_cb = [](void* data, real_t, real_t, real_t) {
      const auto numbers = self(data).text_.numbers();
      self(data).mesh_.add_texcoord({numbers[0], numbers.size() > 1 ? numbers[1] : 0.0});
    };
    callbacks.index_cb = [](void* data, tinyobj::index_t* corners, int count) {
      self(data).add_face({corners, static_cast<std::size_t>(count)});
    };
    callbacks.usemtl_cb = [](void* data, const char* name, int) { self(data).use_material(name); };
    callbacks.group_cb = [](void* data, const char** names, int count) {
      std::string group;
      for (int i = 0; i < count; ++i) group.append(i > 0 ? " " : "").append(names[i]);
      self(data).group_ = group;
      self(data).object_is_known_ = false;
    };
    callbacks.object_cb = [](void* data, const char* name) {
      self(data).object_ = name;
      self(data).object_is_known_ = false;
    };
    return callbacks;
  }

  void add_face(std::span<const tinyobj::index_t> corners) {
    if (!object_is_known_) {
      const std::string between = object_.empty() || group_.empty() ? "" : "/";
      const std::string name = object_ + between + group_;
      object_number_ = objects_.number_of(name.empty() ? "default" : name);
      object_is_known_ = true;
    }
    corners_.clear();
    for (const tinyobj::index_t& corner : corners) {
      corners_.push_back({corner.vertex_index, corner.texcoord_index, corner.normal_index});
    }
    mesh_.add_face(corners_, material_number_, object_number_, text_.lines().line());
  }

  void use_material(const std::string& name) {
    material_number_ = material_names_.number_of(name);
    if (material_number_ == material_places_.size()) {
      material_places_.push_back(text_.lines().place());
    }
  }

  // Names become materials at the end of the file, so that mtllib may come after usemtl.
  void give_materials() {
    scene_.materials = mtl_.materials();
    std::uint32_t default_material = kNoIndex;
    std::vector<std::uint32_t> materials;
    const std::vector<std::string>& names = material_names_.names();
    for (std::size_t i = 0; i < names.size(); ++i) {
      materials.push_back(mtl_.find(names[i]).value_or(kNoIndex));
      if (materials[i] == kNoIndex && !names[i].empty()) {
        scene_.warnings.push_back(material_places_[i] + "material " + in_quotes(names[i]) +
                                  " is defined nowhere, the default instead");
      }
    }
    for (Triangle& triangle : scene_.triangles) {
      if (triangle.material != kNoIndex) triangle.material = materials[triangle.material];
      if (triangle.material != kNoIndex) continue;
      if (default_material == kNoIndex) {
        default_material = static_cast<std::uint32_t>(scene_.materials.size());
        scene_.materials.emplace_back().name = "default";
      }
      triangle.material = default_material;
    }
  }

  const LoadOptions options_;
  Scene scene_;
  ObjText text_;
  MtlLoader mtl_;
  MeshBuilder mesh_;

  NameTable objects_, material_names_;
  std::vector<std::string> material_places_;  // "file:line: " of the first use of each name
  std::string object_, group_;                // in force; empty: none
  std::uint32_t object_number_ = 0;
  bool object_is_known_ = false;
  std::uint32_t material_number_ = kNoIndex;  // into material_names_
  std::vector<FileCorner> corners_;           // of one face
};

}  // namespace

Scene load_obj(const std::filesystem::path& file, const LoadOptions& options) {
  return ObjReader(file, options).read();
}

}  // namespace raygate
