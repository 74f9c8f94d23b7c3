// Metallic-roughness lobes (glTF 2.0): GGX facets over a diffuse base, or rough glass.
#pragma once

#include "host/light/scattering.h"
#include "host/light/surface.h"

namespace raygate {

/// Returns a colour clamped to [0, 1].
template <class T>
RAYGATE_INLINE Triple<T> clamped(const Triple<T>& x) {
  return {at_most(at_least(x.x, 0.0f), 1.0f), at_most(at_least(x.y, 0.0f), 1.0f),
          at_most(at_least(x.z, 0.0f), 1.0f)};
}

/// The lobes for base colour c, metalness m, transmission t, specular weight w, and r0, the normal
/// reflectance of the index of refraction times w and the specular colour. s: Schlick's weight.
///
/// * Facets (Ggx) reflect f0 + (f90 - f0) s with f0 = m c + (1 - m)(1 - t) r0 and
///   f90 = 1 - (1 - m) t - (1 - m)(1 - t)(1 - w).
/// * Multiple scattering: E is the single-scattering albedo of facets that absorb nothing
///   (FacetAlbedo). The lost energy 1 - E returns in the wide lobe
///   (1 - E(view)) (1 - E(light)) / (1 - mean E), reduced by absorption ("Revisiting physically
///   based shading at Imageworks", Kulla and Conty 2017, with Hill's square of the mean Fresnel).
/// * The diffuse base of a dielectric is (1 - m)(1 - t) c times
///   (1 - h(view))(1 - h(light)) / (1 - mean h), where h is the albedo of both lobes above in their
///   brightest channel. So a white material conserves energy, and the BRDF is reciprocal.
/// * The fraction (1 - m) t is glass: facets reflect by Fresnel's formula and transmit c times the
///   rest. Both parts are divided by the albedo of single scattering ("Practical multiple
///   scattering compensation for microfacet models", Turquin 2019), so they are not reciprocal.
///
/// All lobes but glass are multiplied by the opacity. T is float or FloatLanes.
template <class T>
struct MetallicRoughnessLobes {
  using Shares = FacetAlbedo::Shares<T>;

  HitKind kind;
  const FacetAlbedo* albedo;
  Triple<T> view;
  Ggx<T> ggx;
  T alpha;
  T view_cosine;  ///< clamped away from 0
  Triple<T> f0;
  T f90;
  Triple<T> specular;  ///< single-scattering albedo for the view
  Triple<T> multiple;  ///< multiple-scattering albedo
  Triple<T> diffuse;   ///< albedo of the diffuse base
  /// Fraction of glass, and index of refraction behind the interface over the index in front.
  T glass, eta;
  T glass_gain;  ///< compensation for multiple scattering in glass
  MaskOf<T> is_glass;
  Triple<T> tint;  ///< c
  T clear;         ///< 1 - opacity

  MetallicRoughnessLobes() = default;
  RAYGATE_INLINE MetallicRoughnessLobes(const Surface<T>& surface, HitKind hit_kind,
                                        const MaterialParameters* const (&materials)[kLanesOf<T>])
      : kind(hit_kind), albedo(materials[0]->facet_albedo), view(surface.view) {
    using Material = MaterialParameters;
    const T one = spread<T>(1.0f);
    tint = clamped(surface.colour);
    const T metallic = gather<T>(materials, &Material::metallic) * surface.metallic;
    const T roughness = gather<T>(materials, &Material::roughness) * surface.roughness;
    alpha = at_least(roughness * roughness, Ggx<T>::kLeast);
    ggx = Ggx<T>(surface.normal, alpha);
    view_cosine = at_most(at_least(dot(surface.normal, view), 0x1p-20f), 1.0f);
    glass =
        (one - metallic) * (gather<T>(materials, &Material::transmission) * surface.transmission);
    is_glass = glass > 0.0f;
    const T opacity =
        choose(is_glass, one, gather<T>(materials, &Material::opacity) * surface.opacity);
    clear = one - opacity;
    const T index = gather<T>(materials, &Material::index);
    eta = choose(is_glass, choose(surface.outside, index, one / index), one);
    const T plastic = at_least((one - metallic) - glass, 0.0f);
    weight_ = gather<T>(materials, &Material::specular) * surface.specular;
    const Triple<T> reflectance =
        clamped(gather<T>(materials, &Material::reflectance) * surface.specular_color) * weight_;
    most_ = largest(reflectance);
    f0 = (tint * metallic + reflectance * plastic) * opacity;
    f90 = ((one - glass) - plastic * (one - weight_)) * opacity;

    const Shares seen = shares_at(view_cosine), mean = mean_shares();
    specular = f0 * (seen.first - seen.second) + grey(f90) * seen.second;
    plastic_again_ = again(most_, weight_, mean);
    const auto again_of = [&](const T& straight, const T& dielectric) RAYGATE_BODY {
      return metallic * again(straight, one, mean) + plastic * again(dielectric, weight_, mean);
    };
    const T lost = at_least(1.0f - seen.first, 0.0f);
    multiple = Triple<T>{again_of(tint.x, reflectance.x), again_of(tint.y, reflectance.y),
                         again_of(tint.z, reflectance.z)} *
               (lost * opacity);
    diffuse = tint * (plastic * (one - reflected(seen)) * opacity);
    per_lost_mean_ = kPerPi / at_least(1.0f - mean.first, 0x1p-20f);
    per_left_mean_ = kPerPi / at_least(1.0f - reflected(mean), 0x1p-20f);
    glass_gain = one;
    if (has_rough_glass()) {
      const auto table_of = [&](int k) RAYGATE_BODY -> const FacetAlbedo& {
        return *materials[k]->glass_albedo;
      };
      const Shares left = FacetAlbedo::at<T>(table_of, view_cosine, alpha);
      glass_gain = one / choose(surface.outside, left.first, left.second);
    }
  }

  [[nodiscard]] RAYGATE_INLINE bool is_rough() const { return (kind & kGlossy) != 0; }
  [[nodiscard]] RAYGATE_INLINE bool has_rough_glass() const {
    return (~kind & (kGlossy | kMirrors)) == 0;
  }

  /// Returns the BRDF, per steradian, without the cosine, for a direction in front of the surface.
  [[nodiscard]] RAYGATE_INLINE Triple<T> eval(const Triple<T>& light) const {
    const T cosine = at_most(at_least(dot(ggx.normal, light), 0.0f), 1.0f);
    const Shares there = shares_at(cosine);
    const Triple<T> sum = diffuse * ((1.0f - reflected(there)) * per_left_mean_) +
                          multiple * (at_least(1.0f - there.first, 0.0f) * per_lost_mean_);
    if (!is_rough()) return sum;
    const auto pair = ggx.pair(view, light);
    Triple<T> mirrored = schlick(schlick_weight(pair.cos_half));
    if (has_rough_glass()) {
      mirrored = mirrored +
                 grey(glass * glass_gain * fresnel_reflectance(at_most(pair.cos_half, 1.0f), eta));
    }
    return sum + mirrored * (pair.d * ggx.visibility(view_cosine, cosine));
  }

  /// BTDF of rough glass for a direction behind the surface (Walter et al., equation 21), and the
  /// pdf of sampling that direction.
  struct Transmitted {
    Triple<T> value;
    T pdf;
  };
  [[nodiscard]] RAYGATE_INLINE Transmitted transmitted(const Triple<T>& light) const {
    const Triple<T> sum = view + light * eta;
    const T size = dot(sum, sum), per_size = 1.0f / size;
    const T along =
        root(per_size) * choose(dot(sum, ggx.normal) < 0.0f, spread<T>(-1.0f), spread<T>(1.0f));
    const T before = dot(view, sum) * along, beyond = -dot(light, sum) * along;
    const T cosine = -dot(ggx.normal, light);
    const auto is_any = is_glass & (before > 0.0f) & (beyond > 0.0f) & (cosine > 0.0f);
    const T inner = at_most(before, 1.0f);
    // Density of visible facets (VNDF) per steradian of `light`.
    const T facets = 2.0f * ggx.pair(view, light * eta).d * before * beyond *
                     (eta * eta * per_size) / (view_cosine + ggx.stretched(view_cosine));
    const T value = glass * glass_gain * (1.0f - fresnel_reflectance(inner, eta)) * facets *
                    (2.0f / (cosine + ggx.stretched(cosine)));
    return {choose(is_any, tint * value, zero<T>()),
            choose(is_any, facets * (1.0f - mirrored_chance(inner)), T{})};
  }

  /// Samples a direction of the rough lobes: `u` selects the facet; `choice` in [0, 1) selects
  /// reflection or refraction by glass. Returns 0 where glass would refract to the wrong side.
  [[nodiscard]] RAYGATE_INLINE Triple<T> sample(const SquarePoint<T>& u, const T& choice) const {
    const Triple<T> facet = ggx.sample(view, u), mirrored = reflect(view, facet);
    if (!has_rough_glass()) return mirrored;
    const T inner = at_most(at_least(dot(view, facet), 0.0f), 1.0f);
    const Refraction<T> bent(view, facet, eta);
    const auto is_mirrored = (!bent.exists) | (choice < mirrored_chance(inner));
    const Triple<T> way = choose(is_mirrored, mirrored, bent.direction);
    return choose((dot(ggx.normal, way) > 0.0f) == is_mirrored, way, zero<T>());
  }
  /// Returns the pdf of sample(), per steradian, for a direction in front of the surface.
  [[nodiscard]] RAYGATE_INLINE T pdf(const Triple<T>& light) const {
    const auto pair = ggx.pair(view, light);
    const T pdf = ggx.reflection_pdf(view_cosine, pair.d);
    return has_rough_glass() ? pdf * mirrored_chance(at_most(pair.cos_half, 1.0f)) : pdf;
  }

  /// Returns the fraction of light reflected by a sampled facet to `way` that is not masked.
  [[nodiscard]] RAYGATE_INLINE T g2_over_g1(const Triple<T>& way) const {
    const T cosine = dot(ggx.normal, way);
    return choose(cosine > 0.0f, ggx.g2_over_g1(view_cosine, cosine), T{});
  }
  [[nodiscard]] RAYGATE_INLINE T g1(const Triple<T>& way) const {
    const T cosine = -dot(ggx.normal, way);
    return choose(cosine > 0.0f, ggx.g1(cosine), T{});
  }
  /// Returns the reflectance of a facet for a given Schlick weight.
  [[nodiscard]] RAYGATE_INLINE Triple<T> schlick(const T& share) const {
    return f0 + (grey(f90) - f0) * share;
  }
  [[nodiscard]] RAYGATE_INLINE static Triple<T> grey(const T& x) { return {x, x, x}; }

 private:
  /// Returns facets' albedos at a cosine: `first` for reflectance 1, `second` for Schlick's weight.
  [[nodiscard]] RAYGATE_INLINE Shares shares_at(const T& cosine) const {
    if (!is_rough()) return {spread<T>(1.0f), schlick_weight(cosine)};
    return albedo->at(cosine, alpha);
  }
  [[nodiscard]] RAYGATE_INLINE Shares mean_shares() const {
    if (!is_rough()) return {spread<T>(1.0f), spread<T>(1.0f / 21.0f)};
    return albedo->mean(alpha);
  }
  /// Returns the multiple-scattering albedo of facets with reflectance `straight` at normal
  /// incidence and `grazing` at grazing angles.
  [[nodiscard]] RAYGATE_INLINE static T again(const T& straight, const T& grazing,
                                              const Shares& mean) {
    const T each = straight + (grazing - straight) * (1.0f / 21.0f);
    return each * each * mean.first / (1.0f - each * (1.0f - mean.first));
  }
  /// Returns the albedo of dielectric facets, in their brightest colour channel.
  [[nodiscard]] RAYGATE_INLINE T reflected(const Shares& shares) const {
    return most_ * (shares.first - shares.second) + weight_ * shares.second +
           at_least(1.0f - shares.first, 0.0f) * plastic_again_;
  }
  /// Returns the probability that sample() reflects at a facet with this cosine of incidence.
  [[nodiscard]] RAYGATE_INLINE T mirrored_chance(const T& inner) const {
    const T share = glass * fresnel_reflectance(inner, eta);
    const T mirrored = largest(schlick(schlick_weight(inner))) + share;
    const T sum = mirrored + (glass - share) * largest(tint);
    return choose(sum > 0.0f, mirrored / sum, spread<T>(1.0f));
  }

  T weight_, most_, plastic_again_;  // w, largest component of r0, again() of these
  T per_left_mean_, per_lost_mean_;
};

}  // namespace raygate
