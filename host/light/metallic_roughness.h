// Metallic-roughness lobes (glTF 2.0): GGX facets over a diffuse base, or rough glass.
#pragma once

#include "host/base/lane_math.h"
#include "host/light/material_parameters.h"
#include "host/light/sampler.h"
#include "host/light/scattering.h"
#include "host/light/surface.h"

namespace raygate {

/// A colour, limited to [0, 1].
template <class T>
RAYGATE_INLINE Triple<T> clamped(const Triple<T>& x) {
  return {at_most(at_least(x.x, 0.0f), 1.0f), at_most(at_least(x.y, 0.0f), 1.0f),
          at_most(at_least(x.z, 0.0f), 1.0f)};
}

/// For base colour c, metalness m, transmission t, specular weight w and r0, the reflectance
/// straight on of the index of refraction, times w and the specular colour; s is Schlick's Fresnel
/// share of a cosine:
///
/// * Facets (Ggx) reflect f0 + (f90 - f0) s of what meets them: f0 = m c + (1 - m)(1 - t) r0 and
///   f90 = 1 - (1 - m) t - (1 - m)(1 - t)(1 - w).
/// * Under them is (1 - m)(1 - t) c (1 - r0's largest part)(1 - h(view))(1 - h(light)) / (1 - h's
/// mean), diffuse:
///   what glTF 2.0 leaves to implementations. h is a little more than what rough facets reflect for
///   s (CoatAlbedo, below), so that both never add up to more than arrives; and both are the same
///   there and back.
/// * The share (1 - m) t is glass with such facets: Fresnel's formula, and c times what goes
///   through.
///
/// All is multiplied with the opacity. T is float or FloatLanes.
template <class T>
struct MetallicRoughnessLobes {
  /// An upper bound of what facets of a whole surface reflect where one reflects Schlick's share s:
  /// s / (1 + k s) and a little in the middle, fitted to the integral over the facets; its error is
  /// below 1e-4 where it is too small, and 0.06 where it is too large. The mean is over a cosine.
  struct CoatAlbedo {
    T k, middle;

    CoatAlbedo() = default;
    RAYGATE_INLINE explicit CoatAlbedo(const T& alpha)
        : k(18.0f * alpha * alpha / (alpha + 0.07f)), middle(at_most(0.5f * alpha, 0.055f)) {}
    [[nodiscard]] RAYGATE_INLINE T at(const T& cosine) const {
      const T share = schlick_weight(cosine), both = (1.0f - cosine) * cosine;
      return share / (1.0f + k * share) + middle * both * both;
    }
    [[nodiscard]] RAYGATE_INLINE T mean() const {
      return (1.0f / 21.0f) / (1.0f + 0.33f * k) + middle * (1.0f / 30.0f);
    }
  };

  Triple<T> view;
  Ggx<T> ggx;
  CoatAlbedo coat_albedo;
  T view_cosine;  ///< off 0: it is divided by
  Triple<T> f0;
  T f90;
  Triple<T> specular;  ///< what facets reflect of the view, but for what they hide
  Triple<T> diffuse;   ///< what is diffuse of it
  T glass, eta;        ///< the share of glass; its index beyond the border over that before
  MaskOf<T> is_glass;
  Triple<T> tint;  ///< c
  T clear;         ///< what the opacity leaves

  MetallicRoughnessLobes() = default;
  RAYGATE_INLINE MetallicRoughnessLobes(
      const Surface<T>& surface, bool is_rough,
      const MaterialParameters* const (&materials)[LanesOf<T>::kCount]) {
    using Material = MaterialParameters;
    const T one = spread<T>(1.0f), opacity = gather<T>(materials, &Material::opacity);
    clear = one - opacity;
    tint = clamped(surface.colour);
    const T metallic = gather<T>(materials, &Material::metallic) * surface.metallic;
    const T roughness = gather<T>(materials, &Material::roughness) * surface.roughness;
    view = surface.view;
    const T alpha = at_least(roughness * roughness, Ggx<T>::kLeast);
    ggx = Ggx<T>(surface.normal, alpha);
    view_cosine = at_most(at_least(dot(surface.normal, view), 0x1p-20f), 1.0f);
    glass = (one - metallic) * gather<T>(materials, &Material::transmission);
    const T plastic = at_least((one - metallic) - glass, 0.0f);
    const Triple<T> reflectance = gather<T>(materials, &Material::reflectance);
    f0 = (tint * metallic + reflectance * plastic) * opacity;
    f90 = ((one - glass) - plastic * (one - gather<T>(materials, &Material::specular))) * opacity;
    coat_albedo = CoatAlbedo(is_rough ? alpha : T{});
    const T share = coat_albedo.at(view_cosine);
    specular = schlick(share);
    diffuse = tint * (plastic * (one - largest(reflectance)) * (one - share) * opacity);
    const T index = gather<T>(materials, &Material::index);
    is_glass = glass > 0.0f;
    eta = choose(is_glass, choose(surface.outside, index, one / index), one);
  }

  /// Per steradian and without the cosine, for a direction before the surface; `is_rough`: with
  /// what facets reflect; `with_glass`: also those of glass.
  [[nodiscard]] RAYGATE_INLINE Triple<T> eval(const Triple<T>& light, bool is_rough,
                                              bool with_glass) const {
    constexpr float kPerPi = 0.318309886183790671537767526745f;
    const T cosine = at_least(dot(ggx.normal, light), 0.0f);
    const Triple<T> lambert = diffuse * (kPerPi * (1.0f - coat_albedo.at(at_most(cosine, 1.0f))) /
                                         (1.0f - coat_albedo.mean()));
    if (!is_rough) return lambert;
    const auto pair = ggx.pair(view, light);
    Triple<T> reflected_there = schlick(schlick_weight(pair.cos_half));
    if (with_glass) {
      const T inner = at_most(pair.cos_half, 1.0f);
      reflected_there = reflected_there + grey(glass * fresnel_reflectance(inner, eta));
    }
    return lambert + reflected_there * (pair.d * ggx.visibility(view_cosine, cosine));
  }

  /// How likely reflect(view, ggx.sample(view, ..)) is, per steradian.
  [[nodiscard]] RAYGATE_INLINE T pdf(const Triple<T>& light) const {
    return ggx.reflection_pdf(view_cosine, ggx.pair(view, light).d);
  }

  /// One facet of glass, chosen among those that the view sees, and what Fresnel's formula gives
  /// it.
  struct SampledFacet {
    Triple<T> normal;
    T reflectance;
  };
  [[nodiscard]] RAYGATE_INLINE SampledFacet sample_glass_facet(const SquarePoint<T>& u) const {
    const Triple<T> facet = ggx.sample(view, u);
    const T cosine = at_most(at_least(dot(facet, view), 0.0f), 1.0f);
    return {facet, fresnel_reflectance(cosine, eta)};
  }
  /// What gets away of what a sampled facet mirrors, or lets through, in this direction.
  [[nodiscard]] RAYGATE_INLINE T g2_over_g1(const Triple<T>& way) const {
    const T cosine = dot(ggx.normal, way);
    return choose(cosine > 0.0f, ggx.g2_over_g1(view_cosine, cosine), T{});
  }
  [[nodiscard]] RAYGATE_INLINE T g1(const Triple<T>& way) const {
    const T cosine = -dot(ggx.normal, way);
    return choose(cosine > 0.0f, ggx.g1(cosine), T{});
  }
  /// What a facet reflects at which Schlick's share is this.
  [[nodiscard]] RAYGATE_INLINE Triple<T> schlick(const T& share) const {
    return f0 + (grey(f90) - f0) * share;
  }

 private:
  [[nodiscard]] RAYGATE_INLINE static Triple<T> grey(const T& x) { return {x, x, x}; }
};

}  // namespace raygate
