// Converts a material of any file format to the parameters that shading reads.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

class FacetAlbedo;

/// Features of a hit's material, as a bit mask. Hits with equal masks are shaded together.
using HitKind = std::uint32_t;
inline constexpr HitKind kInterpolates = 1;        ///< a vertex attribute is interpolated
inline constexpr HitKind kEmits = 2;               ///< an emitter, or an unlit colour
inline constexpr HitKind kGlossy = 4;              ///< a glossy lobe
inline constexpr HitKind kMirrors = 8;             ///< a mirror
inline constexpr HitKind kTransmits = 16;          ///< transmission
inline constexpr HitKind kShadowCatcher = 32;      ///< shows the background and shadows on it
inline constexpr HitKind kMetallicRoughness = 64;  ///< metallic-roughness; rough if kGlossy is set
inline constexpr HitKind kIsBumpy = 128;           ///< a normal map
inline constexpr HitKind kHitKinds = 256;          ///< number of masks

/// Direction-independent parameters of MTL's models (see Bsdf) or of the metallic-roughness model.
struct MaterialParameters {
  glm::vec3 diffuse{0.0f};  ///< multiplies the texture; at most 1
  glm::vec3 unlit{0.0f};    ///< multiplies the texture
  glm::vec3 glossy{0.0f};
  glm::vec3 mirror{0.0f};         ///< reflectance at normal incidence
  glm::vec3 grazing{0.0f};        ///< additional reflectance at grazing angles
  glm::vec3 transmittance{0.0f};  ///< of the light that the mirror does not reflect
  glm::vec3 emission{0.0f};
  float opacity = 1.0f;  ///< d, or 0 for clear glass
  float exponent = 0.0f;
  float index = 1.0f;     ///< index of refraction
  bool is_glass = false;  ///< lobes below the mirror receive only light that it does not reflect
  bool refracts = false;
  bool is_fresnel = false;    ///< the mirror follows Fresnel's formula
  bool emits_evenly = false;  ///< the emission has no texture
  /// Metallic-roughness materials only; textures multiply all of these.
  float metallic = 0.0f, roughness = 1.0f, transmission = 0.0f;
  float specular = 1.0f;         ///< of dielectrics: reflectance at grazing angles
  glm::vec3 reflectance{0.04f};  ///< of dielectrics at normal incidence, before the factor specular
  const FacetAlbedo* facet_albedo = nullptr;  ///< of rough facets, or null
  const FacetAlbedo* glass_albedo = nullptr;  ///< of rough glass, or null
  HitKind kind = 0;                           ///< without bits that depend on the triangle

  bool has_mask = false;  ///< if set, hits with is_masked_out() use hole() instead
  bool is_hole = false;

  explicit MaterialParameters(const Material& material);

  /// Returns whether this is a mirror or smooth glass, whose directions are not random.
  [[nodiscard]] bool is_mirror_or_glass() const {
    constexpr HitKind kRoughGlass = kMetallicRoughness | kGlossy | kMirrors;
    return (kind & kMirrors) != 0 && (~kind & kRoughGlass) != 0;
  }

  /// Returns the material of a hole in a mask: light passes straight through.
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
