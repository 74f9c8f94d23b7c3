// Materials and textures of a glTF file as those of a Scene.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Turns materials into those of a scene, each once, with their textures.
///
/// Their terms are glTF's own. KHR_materials_unlit has no shading (illum 0).
class GltfMaterials {
 public:
  /// Without `textures` none is decoded.
  GltfMaterials(const GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), textures_(textures) {}

  /// The scene's number of the file's material; -1 is the default.
  std::uint32_t number_of(int material);
  /// Returns the sets of texture coordinates that its textures ask for, two at most; -1: none.
  using Sets = std::array<int, 2>;
  [[nodiscard]] Sets texcoord_sets(int material);
  /// Whether the opacity of its vertices counts.
  [[nodiscard]] bool has_opacity(int material) const;
  /// Multiplies its opacity by that of its vertices.
  void use_vertex_opacity(int material);

 private:
  Material translated(const tinygltf::Material& from);
  void set_opacity(const tinygltf::Material& from, Material& material);
  [[nodiscard]] Sets sets_of(const tinygltf::Material& from);
  /// Returns the texture in the scene, and how it lies; none for index -1.
  template <class TextureInfo>
  MaterialMap read_map(const TextureInfo& info, Texture::Content content);
  /// Returns the same; none, with a warning, where it cannot be read.
  template <class TextureInfo>
  MaterialMap map_of(const TextureInfo& info, Texture::Content content);
  /// Decoded; nothing, and a warning, where there is none.
  std::optional<Texture> picture(int texture, Texture::Content content);

  const GltfFile& file_;
  Scene& scene_;
  const bool textures_;
  std::map<int, std::uint32_t> numbers_;  // of materials
  Sets sets_{-1, -1};                     // of the material that is being read
  /// In the scene; kNoIndex: there is none.
  std::map<std::pair<int, Texture::Content>, std::uint32_t> texture_of_image_;
  std::int64_t texels_ = 0;  // that were decoded
};

}  // namespace raygate
