#include "host/light/material_parameters.h"

#include <algorithm>

#include "host/light/scattering.h"

namespace raygate {
namespace {

constexpr float kMostIndex = 0x1p20f;
constexpr float kLeastIndex = 0x1p-20f;

glm::vec3 limited(const glm::vec3& colour) {
  return glm::clamp(colour, glm::vec3(0.0f), glm::vec3(1.0f));
}

bool is_any(const glm::vec3& colour) { return colour != glm::vec3(0.0f); }

}  // namespace

/// Sets the parameters of a metallic-roughness material. Glass ignores the opacity.
void MaterialParameters::set(const Material& material, const MetallicRoughness& shares) {
  metallic = std::clamp(shares.metallic, 0.0f, 1.0f);
  transmission = std::clamp(shares.transmission, 0.0f, 1.0f);
  if (index == 1.0f) index = 1.5f;
  const float root = (index - 1.0f) / (index + 1.0f);
  specular = std::clamp(shares.specular, 0.0f, 1.0f);
  reflectance = root * root * shares.specular_color;
  const bool has_map =
      shares.roughness_map.texture != kNoIndex || shares.metallic_map.texture != kNoIndex;
  refracts = transmission > 0.0f && (metallic < 1.0f || has_map);
  is_glass = is_fresnel = false;
  opacity = refracts ? 1.0f : std::clamp(material.opacity, 0.0f, 1.0f);
  transmittance = glm::vec3(1.0f - opacity);
  // Roughness textures may have any value, so such a material is never treated as smooth.
  roughness = std::clamp(shares.roughness, 0.0f, 1.0f);
  const bool is_rough = has_map || roughness * roughness >= Ggx<float>::kLeast;
  kind |= kMetallicRoughness | (is_rough ? kGlossy : kMirrors);
  if (is_rough) facet_albedo = &FacetAlbedo::of_mirrors();
  if (is_rough && refracts) glass_albedo = &FacetAlbedo::of_glass(index);
  if (refracts) kind |= kMirrors;
  if (refracts || opacity < 1.0f) kind |= kTransmits;
  for_each_map(shares, [&](const MaterialMap& map) {
    if (map.texture != kNoIndex) kind |= kInterpolates;
  });
}

MaterialParameters::MaterialParameters(const Material& material) {
  const int model = material.illumination_model;
  is_glass = model == 4 || model == 6 || model == 7 || model == 9;
  refracts = model == 6 || model == 7;
  is_fresnel = model == 7;
  const float d = std::clamp(material.opacity, 0.0f, 1.0f);
  opacity = is_glass && d == 1.0f ? 0.0f : d;
  exponent = std::clamp(material.shininess, 0.0f, 1e6f);
  index = std::clamp(material.refraction_index, kLeastIndex, kMostIndex);
  emission = material.emission;
  if (is_any(emission)) kind |= kEmits;
  emits_evenly = is_any(emission) && material.emission_map.texture == kNoIndex;
  if (material.diffuse_map.texture != kNoIndex) kind |= kInterpolates;
  if (material.emission_map.texture != kNoIndex) kind |= kInterpolates;
  if (material.normal_map.texture != kNoIndex) kind |= kInterpolates | kIsBumpy;
  has_mask = (material.opacity_map.texture != kNoIndex || material.has_vertex_opacity) &&
             !material.opacity_blends;
  if (material.opacity_blends) kind |= kInterpolates | kTransmits;
  if (material.metallic_roughness) {
    set(material, *material.metallic_roughness);
    return;
  }
  const glm::vec3 ks = limited(material.specular);
  (model == 0 ? unlit : diffuse) = glm::vec3(opacity);
  if (model == 2) glossy = opacity * ks;
  if (model == 3 || model == 5 || model == 8) mirror = opacity * ks;
  if (model == 5) grazing = opacity * (1.0f - ks);
  if (model == 4 || model == 6 || model == 9) mirror = ks;
  transmittance = (1.0f - opacity) * (is_glass ? limited(material.transmittance) : glm::vec3(1.0f));
  if (is_any(unlit)) kind |= kEmits;
  if (is_any(glossy)) kind |= kGlossy;
  if (is_any(mirror) || is_any(grazing) || refracts) kind |= kMirrors;
  if (is_any(transmittance)) kind |= kTransmits;
  if (model == 10) kind |= kShadowCatcher;
}

}  // namespace raygate
