// glTF's metallic-roughness materials as the materials that we have.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Turns materials into those of a scene, each once, with their textures.
///
/// Of base colour c, metalness m and roughness r: Kd = c (1 - m (1 - r)), times the texture; Ks =
/// (0.04 (1 - m) + c m) (1 - r), a highlight of exponent 0.5 / r^4, or a mirror below r = 0.1 (by
/// Fresnel's formula where m < 0.5). Textures of metalness, roughness and emission count by their
/// mean. KHR_materials_transmission of 0.5 and more is glass; KHR_materials_unlit has no shading.
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, Scene& scene) : file_(file), scene_(scene) {}

  /// The scene's number of the file's material; -1 is the default.
  std::uint32_t number_of(int material);
  /// Which set of texture coordinates its texture asks for; -1: it has none.
  [[nodiscard]] int texcoord_set(int material) const;

 private:
  Material translated(const tinygltf::Material& from);
  void add_texture(const tinygltf::TextureInfo& info, Material& material);
  /// Decoded; nothing, and a warning, where there is none.
  std::optional<Texture> picture(int texture);
  /// Of all its texels, from 0 to 1; of a picture that is missing 1.
  glm::dvec3 mean_codes(int texture);
  void warn_once(const std::string& what);

  const GltfFile& file_;
  Scene& scene_;
  std::map<int, std::uint32_t> numbers_;           // of materials
  std::map<int, std::uint32_t> texture_of_image_;  // in the scene; kNoIndex: there is none
  std::map<int, glm::dvec3> means_;                // by image
  std::int64_t texels_ = 0;                        // that were decoded
};

}  // namespace raygate
