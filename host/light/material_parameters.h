// Material parameters: a material of any file format as the one record that shading reads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

class FacetAlbedo;

/// Features of a hit's material: a set of these bits. Hits with the same set are shaded together.
using HitKind = std::uint32_t;
inline constexpr HitKind kInterpolates = 1;  ///< something is interpolated between the vertices
inline constexpr HitKind kEmits = 2;    ///< an emitter, or a colour that is only there to be seen
inline constexpr HitKind kGlossy = 4;   ///< a highlight
inline constexpr HitKind kMirrors = 8;  ///< a mirror
inline constexpr HitKind kTransmits = 16;          ///< light passes
inline constexpr HitKind kShadowCatcher = 32;      ///< of the background's colour but for shadows
inline constexpr HitKind kMetallicRoughness = 64;  ///< metallic-roughness; rough where it is glossy
inline constexpr HitKind kIsBumpy = 128;           ///< a normal map
inline constexpr HitKind kCoated = 256;  ///< a clear coat: of kMetallicRoughness and kGlossy alone
inline constexpr HitKind kHitKinds = 512;  ///< sets are less than that

/// The lobes of a material before an angle is known. MTL's illumination models (Bsdf has the table)
/// and metallic-roughness materials meet in this record.
struct MaterialParameters {
  glm::vec3 diffuse{0.0f};  ///< of the texture's colour, limited to 1
  glm::vec3 unlit{0.0f};    ///< of the same
  glm::vec3 glossy{0.0f};
  glm::vec3 mirror{0.0f};         ///< straight on, and
  glm::vec3 grazing{0.0f};        ///< so much more at grazing angles
  glm::vec3 transmittance{0.0f};  ///< of what the mirror leaves
  glm::vec3 emission{0.0f};
  float opacity = 1.0f;  ///< d, or 0 for clear glass
  float exponent = 0.0f;
  float index = 1.0f;     ///< of refraction
  bool is_glass = false;  ///< what the mirror takes is gone for all that lies under it
  bool refracts = false;
  bool is_fresnel = false;  ///< the mirror is Fresnel's
  bool mirror_is_traced = true;
  bool emits_evenly = false;  ///< the same everywhere on it
  /// Of a metallic-roughness material, which has the textures' colours in all its shares:
  float metallic = 0.0f, roughness = 1.0f, transmission = 0.0f;
  float specular = 1.0f;         ///< of what is not metallic, at grazing angles; and, times this,
  glm::vec3 reflectance{0.04f};  ///< straight on, limited to 1
  float coat = 0.0f, coat_roughness = 0.0f;
  const FacetAlbedo* facet_albedo = nullptr;  ///< of what is rough,
  const FacetAlbedo* glass_albedo = nullptr;  ///< and of what is rough glass
  HitKind kind = 0;                           ///< without what depends on the triangle

  bool has_mask = false;  ///< where is_masked_out() says so, hits have hole() instead
  bool is_hole = false;

  explicit MaterialParameters(const Material& material);

  /// Whether this is a mirror or glass that is smooth: its directions are not random.
  [[nodiscard]] bool is_mirror_or_glass() const {
    constexpr HitKind kRoughGlass = kMetallicRoughness | kGlossy | kMirrors;
    return (kind & kMirrors) != 0 && (~kind & kRoughGlass) != 0 && (mirror_is_traced || refracts);
  }

  /// The hole of a mask: all light goes straight on.
  [[nodiscard]] static MaterialParameters hole() {
    Material clear;
    clear.illumination_model = 1;
    clear.opacity = 0.0f;
    MaterialParameters parameters(clear);
    parameters.is_hole = true;
    return parameters;
  }

 private:
  void set(const Material& material, const MetallicRoughness& shares);
};

}  // namespace raygate
