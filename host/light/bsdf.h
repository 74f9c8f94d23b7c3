// BSDF: reflection and transmission of a material, as lobes that never add energy.
#pragma once

#include "host/light/metallic_roughness.h"
#include "host/light/scattering.h"
#include "host/light/surface.h"

namespace raygate {

/// The BSDF of hits of one kind: four lobes, each with a colour as its albedo.
///
/// `illum`, the illumination model of an MTL file, selects the lobes. Kd, Ks, Ns, Tf and Ni are
/// MTL's; d is the opacity (1: opaque). Except for glass, a sum of lobes above d is scaled to d.
///
/// | illum | diffuse | glossy | mirror | transmission |
/// |---|---|---|---|---|
/// | 0 | none: Kd is shown as it is, unlit | | | 1 - d, straight |
/// | 1 | d Kd | | | 1 - d, straight |
/// | 2 | d Kd | d Ks, exponent Ns | | 1 - d, straight |
/// | 3 | d Kd | | d Ks | 1 - d, straight |
/// | 4 | d Kd | | Ks | the rest of (1 - d) Tf, straight: thin glass |
/// | 5 | d Kd | | d times Schlick's Fresnel from Ks | 1 - d, straight |
/// | 6 | d Kd | | Ks | the rest of (1 - d) Tf, refracted by Ni |
/// | 7 | d Kd | | Fresnel's formula for Ni | the rest of (1 - d) Tf, refracted by Ni |
/// | 8, 9 | as 3, 4 | | | |
/// | 10 | as 1, with the colour at which it looks like the background (catcher_colour) | | | |
///
/// With 4, 6, 7 and 9, d = 1 counts as 0: these models imply a clear material, but exporters leave
/// d at its default of 1. All radiance is divided by the squared index of refraction of its medium;
/// the quotient does not change at an interface. "The rest" is the fraction of light that the
/// mirror does not reflect. A mirror cannot show a point light, which has no size. It shows a
/// highlight with exponent Ns instead, unless Ns is at most 1 (0 is the default).
///
/// A metallic-roughness material has the lobes of MetallicRoughnessLobes instead: `diffuse` is the
/// base below the facets, `glossy` the reflection of rough facets, and `mirror` the reflection of
/// smooth facets. Glass has `mirror` and `transmission`. For rough glass, these two are the albedos
/// of smooth glass, and eval(), sample() and pdf() scatter to both sides.
///
/// T is float or FloatLanes: hits of one kind, each with its own material.
template <class T>
class Bsdf {
 public:
  Bsdf() = default;
  RAYGATE_INLINE Bsdf(const Surface<T>& surface, HitKind kind,
                      const MaterialParameters* const (&materials)[kLanesOf<T>]);

  /// Returns the BSDF of the same hits as seen from another direction on the same side.
  [[nodiscard]] RAYGATE_INLINE Bsdf seen_from(
      const Surface<T>& seen, const MaterialParameters* const (&materials)[kLanesOf<T>]) const {
    if ((kind_ & (kMirrors | kTransmits | kMetallicRoughness)) != 0) {
      return Bsdf(seen, kind_, materials);
    }
    Bsdf other = *this;  // no lobe's colour depends on the view
    other.view_ = seen.view;
    other.normal_ = seen.normal;
    return other;
  }

  Triple<T> diffuse, glossy, mirror, transmission;
  Triple<T> emission;  ///< emitted radiance (Ke)
  Triple<T> unlit;     ///< radiance that is visible but lights nothing (illum 0)
  MaskOf<T> is_refracting;
  T eta;  ///< index of refraction behind the interface over the index in front
  MetallicRoughnessLobes<T> facets;  ///< only for kMetallicRoughness

  /// Returns whether there is a lobe that is not specular: diffuse, glossy, or rough glass.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> scatters() const {
    return largest(diffuse) + glossy_sum() > 0.0f;
  }
  /// Returns whether lights are sampled: if scatters(), or if a mirror shows highlights.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> samples_lights() const {
    const MaskOf<T> scatters = this->scatters();
    if (!has_highlight()) return scatters;
    const auto has_one = largest(highlight()) > 0.0f;
    return scatters | has_one;
  }
  /// Returns the approximate albedo of all lobes that are not specular.
  [[nodiscard]] RAYGATE_INLINE T scattered_share() const {
    return has_rough_glass() ? largest(diffuse) + glossy_sum() : largest(diffuse + glossy);
  }

  /// Returns the BSDF without specular lobes, per steradian and without the cosine, for the unit
  /// vector `light`. The result is 0 behind the surface, except for rough glass.
  [[nodiscard]] RAYGATE_INLINE Triple<T> eval(const Triple<T>& light) const {
    if ((kind_ & kMetallicRoughness) != 0) {
      const Triple<T> reflected = above(light, facets.eval(light));
      return has_rough_glass() ? reflected + facets.transmitted(light).value : reflected;
    }
    return above(light, (kind_ & kGlossy) != 0
                            ? diffuse * spread<T>(kPerPi) + glossy * phong_lobe(light)
                            : diffuse * spread<T>(kPerPi));
  }
  /// Returns eval(), plus the highlight of mirrors in lanes whose light is a point.
  [[nodiscard]] RAYGATE_INLINE Triple<T> eval(const Triple<T>& light,
                                              const MaskOf<T>& is_from_point) const {
    if (!has_highlight() || !any(is_from_point)) return eval(light);
    const Triple<T> shown = choose(is_from_point, highlight(), zero<T>());
    return above(light, diffuse * spread<T>(kPerPi) + (glossy + shown) * phong_lobe(light));
  }

  /// Samples a direction, approximately in proportion to eval() times the cosine, for a point of
  /// the unit square. A direction that is 0 or points behind the surface contributes nothing,
  /// except behind rough glass. `choice` in [0, 1): see MetallicRoughnessLobes::sample.
  [[nodiscard]] RAYGATE_INLINE Triple<T> sample(const SquarePoint<T>& u,
                                                const T& choice = T{}) const {
    if ((kind_ & kGlossy) == 0) {
      return spherical_direction(normal_, root(1.0f - u.x), root(u.x), u.y);
    }
    const T share = glossy_share(), left = 1.0f - share;
    const auto is_glossy = u.x < share;
    // The position of u.x in its lobe's interval selects the angle from the axis.
    const T glossy_rest = 1.0f - u.x / choose(share > 0.0f, share, spread<T>(1.0f));
    const T diffuse_rest = (u.x - share) / choose(left > 0.0f, left, spread<T>(1.0f));
    const T rest = at_most(at_least(choose(is_glossy, glossy_rest, diffuse_rest), 0.0f), 1.0f);
    if ((kind_ & kMetallicRoughness) != 0) {
      // Both lobes can use the same point, because each lane needs only one lobe.
      return choose(is_glossy, facets.sample({rest, u.y}, choice),
                    spherical_direction(normal_, root(1.0f - rest), root(rest), u.y));
    }
    const auto cosine = power(wide(at_least(rest, 0x1p-24f)), 1.0 / (wide(exponent_) + 1.0));
    const T sine = narrow(root(1.0 - cosine * cosine));
    const Triple<T> axis = choose(is_glossy, reflect(view_, normal_), normal_);
    return spherical_direction(axis, choose(is_glossy, narrow(cosine), root(1.0f - rest)),
                               choose(is_glossy, sine, root(rest)), u.y);
  }
  /// Returns the probability density of sample(), per steradian.
  [[nodiscard]] RAYGATE_INLINE T pdf(const Triple<T>& light) const {
    const T lambertian = at_least(dot(normal_, light), 0.0f) * kPerPi;
    if ((kind_ & kGlossy) == 0) return lambertian;
    const T share = glossy_share();
    if ((kind_ & kMetallicRoughness) != 0) {
      const T reflected = choose(dot(normal_, light) > 0.0f, facets.pdf(light), T{});
      return (1.0f - share) * lambertian +
             share * (has_rough_glass() ? reflected + facets.transmitted(light).pdf : reflected);
    }
    return (1.0f - share) * lambertian +
           share * (phong_lobe(light) * ((exponent_ + 1.0f) / (exponent_ + 2.0f)));
  }

  /// Returns whether the lobes include rough glass, which scatters to both sides.
  [[nodiscard]] RAYGATE_INLINE bool has_rough_glass() const {
    return (~kind_ & (kMetallicRoughness | kGlossy | kMirrors)) == 0;
  }

 private:
  [[nodiscard]] RAYGATE_INLINE Triple<T> above(const Triple<T>& light,
                                               const Triple<T>& value) const {
    return choose(dot(normal_, light) > 0.0f, value, zero<T>());
  }
  [[nodiscard]] RAYGATE_INLINE bool has_highlight() const {
    return (kind_ & kMirrors) != 0 && (kind_ & kMetallicRoughness) == 0;
  }
  /// Returns the albedo of a mirror's highlight, which shows point lights.
  [[nodiscard]] RAYGATE_INLINE Triple<T> highlight() const {
    return choose(exponent_ > 1.0f, mirror, zero<T>());
  }
  [[nodiscard]] RAYGATE_INLINE T glossy_sum() const {
    const T sum = largest(glossy);
    return has_rough_glass() ? sum + largest(mirror) + largest(transmission) : sum;
  }
  [[nodiscard]] RAYGATE_INLINE T glossy_share() const {
    const T glossy_only = glossy_sum(), sum = glossy_only + largest(diffuse);
    return choose(glossy_only > 0.0f, glossy_only / sum, T{});
  }

  /// Returns Phong's lobe around the reflected view, normalised to conserve energy (Lafortune and
  /// Willems 1994). The cosine is computed from the distance of the two directions, and its power
  /// in double: for large exponents, float cosines near 1 are too coarse.
  [[nodiscard]] RAYGATE_INLINE T phong_lobe(const Triple<T>& light) const {
    const Triple<T> apart = reflect(view_, normal_) - light;
    const T squared = dot(apart, apart);
    const auto cosine = 1.0 - 0.5 * wide(at_most(squared, 1.99999f));
    const T height = (exponent_ + 2.0f) * (0.5f * kPerPi);
    return choose(squared < 1.99999f, height * narrow(power(cosine, wide(exponent_))), T{});
  }

  HitKind kind_;
  Triple<T> view_, normal_;
  T exponent_;
};

template <class T>
RAYGATE_INLINE Bsdf<T>::Bsdf(const Surface<T>& surface, HitKind kind,
                             const MaterialParameters* const (&materials)[kLanesOf<T>])
    : kind_(kind), view_(surface.view), normal_(surface.normal) {
  using Material = MaterialParameters;
  const Triple<T>& colour = surface.colour;
  diffuse = clamped(colour) * gather<T>(materials, &Material::diffuse);
  glossy = mirror = transmission = emission = unlit = zero<T>();
  const T opacity = gather<T>(materials, &Material::opacity), one = spread<T>(1.0f);
  eta = one;
  exponent_ = T{};
  is_refracting = one < 0.0f;
  if ((kind & kEmits) != 0) {
    emission = gather<T>(materials, &Material::emission);
    if ((kind & kInterpolates) != 0) emission = emission * surface.glow;
    unlit = colour * gather<T>(materials, &Material::unlit);
  }
  if ((kind & kMetallicRoughness) != 0) {
    facets = MetallicRoughnessLobes<T>(surface, kind, materials);
    diffuse = facets.diffuse + facets.multiple;
    ((kind & kGlossy) != 0 ? glossy : mirror) = facets.specular;
    transmission = facets.grey(facets.clear);
    if ((~kind & (kMirrors | kTransmits)) != 0) return;
    eta = facets.eta;
    is_refracting = facets.is_glass;
    const T mirrored = facets.glass * fresnel_reflectance(facets.view_cosine, eta);
    mirror = mirror + facets.grey(mirrored);
    transmission = choose(is_refracting, facets.tint * (facets.glass - mirrored), transmission);
    return;
  }
  if ((kind & (kGlossy | kMirrors)) != 0) {
    glossy = gather<T>(materials, &Material::glossy);
    exponent_ = gather<T>(materials, &Material::exponent);
  }
  auto is_glass = is_refracting;
  if ((kind & (kMirrors | kTransmits)) != 0) {
    is_glass = gather<T>(materials, &Material::is_glass);
    is_refracting = gather<T>(materials, &Material::refracts);
    const T index = gather<T>(materials, &Material::index);
    eta = choose(is_refracting, choose(surface.outside, index, 1.0f / index), one);
    const T cosine = at_most(at_least(dot(normal_, view_), 0.0f), 1.0f);
    mirror = gather<T>(materials, &Material::mirror) +
             gather<T>(materials, &Material::grazing) * schlick_weight(cosine);
    const T reflectance = fresnel_reflectance(cosine, eta);
    const auto is_fresnel =
        is_refracting & (gather<T>(materials, &Material::is_fresnel) | (reflectance >= 1.0f));
    mirror = choose(is_fresnel, Triple<T>{reflectance, reflectance, reflectance}, mirror);
    // Light that a glass mirror reflects does not reach the lobes below it.
    const Triple<T> rest =
        choose(is_glass, Triple<T>{one, one, one} - mirror, Triple<T>{one, one, one});
    diffuse = diffuse * rest;
    transmission = gather<T>(materials, &Material::transmittance) * rest;
  }
  if ((kind & (kGlossy | kMirrors)) != 0) {
    const T sum = largest(diffuse + glossy + mirror);
    const T scale = choose((sum > opacity) & !is_glass, opacity / sum, one);
    diffuse = diffuse * scale;
    glossy = glossy * scale;
    mirror = mirror * scale;
  }
  if ((~kind & (kInterpolates | kTransmits)) != 0) return;
  diffuse = diffuse * surface.opacity;
  glossy = glossy * surface.opacity;
  mirror = mirror * surface.opacity;
  unlit = unlit * surface.opacity;
  const T clear = one - surface.opacity;
  transmission = transmission * surface.opacity + Triple<T>{clear, clear, clear};
}

/// Returns the BSDF at one hit.
[[nodiscard]] inline Bsdf<float> bsdf_at(const Scene& scene, const Bvh& bvh,
                                         const SurfaceHit& place,
                                         const MaterialParameters& material) {
  const HitKind kind = material.kind | weights_needed(scene, place);
  const SurfaceHit places[] = {place};
  const MaterialParameters* const materials[] = {&material};
  return {surface_at<float>(scene, bvh, kind, places), kind, materials};
}

}  // namespace raygate
