// GltfMaterials: converts the materials and textures of a glTF file to those of a Scene.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Converts each material that is used, and its textures, once. A material with
/// KHR_materials_unlit is not shaded (illumination model 0).
class GltfMaterials {
 public:
  /// `file` and `scene` must outlive this object. If `textures` is false, no image is decoded.
  GltfMaterials(GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), textures_(textures) {}

  struct Converted {
    std::uint32_t number;  ///< index into Scene::materials
    std::array<int, 2>
        texcoord_sets;  ///< sets that its textures use, the base colour's first; -1: none
  };
  /// Returns a material of the file, which is converted at its first use; -1 is the default one.
  Converted convert(int material);
  /// Returns whether a material has a mask or blends.
  [[nodiscard]] bool has_opacity(int material) const;
  /// Lets the opacities of vertices multiply a material's.
  void use_vertex_opacity(int material);

 private:
  /// Returns a member of a list of a material; an empty list, with a warning if the member is not
  /// `size` numbers.
  std::vector<double> numbers(const Json& object, const char* key, std::size_t size);
  Material translated(const Json& from);
  void set_opacity(const Json& from, Material& material);
  /// Returns the material with this index, or null for index -1.
  [[nodiscard]] const Json& material(int index) const;
  /// Returns the texture at a key with its mapping; no texture if there is none or, with a warning,
  /// if it cannot be read.
  MaterialMap map_of(const Json& parent, const char* key,
                     Texture::Content content = Texture::Content::kColour);
  MaterialMap read_map(const Json& info, Texture::Content content);
  /// Returns a decoded image; nullopt, with a warning, if the texture has none. Throws InputError
  /// if it cannot be decoded or the images have too many pixels.
  std::optional<Texture> picture(const Json& texture, Texture::Content content);

  GltfFile& file_;
  Scene& scene_;
  const bool textures_;
  std::map<int, Converted> converted_;  // by the material's index in the file
  std::array<int, 2> sets_{-1, -1};     // texcoord_sets of the material that is being read
  /// Textures of the scene by image of the file; kNoIndex: it could not be read.
  std::map<std::pair<int, Texture::Content>, std::uint32_t> texture_of_image_;
  std::int64_t texels_ = 0;  // decoded so far
};

}  // namespace raygate
