// Smooth and rough interfaces of media: Fresnel's formulas, reflection, refraction, the GGX
// distribution of microfacets and a table of their albedo. T is float or FloatLanes.
#pragma once

#include "host/light/sampler.h"

namespace raygate {

inline constexpr float kPerPi = 0.318309886183790671537767526745f;  ///< 1 / pi

/// Returns the squared cosine of the angle of refraction; negative for total reflection. `cosine`
/// belongs to the angle of incidence and is in [0, 1]; `eta` is the index of refraction beyond the
/// interface over the index before it.
template <class T>
RAYGATE_INLINE T transmitted_cosine_squared(const T& cosine, const T& eta) {
  return 1.0f - (1.0f - cosine * cosine) / (eta * eta);
}

/// Returns the fraction of unpolarised light that a smooth interface reflects, by Fresnel's
/// formulas: the mean of |r|^2 of both polarisations. 1 for total reflection.
template <class T>
RAYGATE_INLINE T fresnel_reflectance(const T& cosine, const T& eta) {
  const T squared = transmitted_cosine_squared(cosine, eta);
  const T beyond = root(at_least(squared, 0.0f));
  const T across = (cosine - eta * beyond) / (cosine + eta * beyond);
  const T parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  const T one = spread<T>(1.0f);
  return choose(squared <= 0.0f, one, 0.5f * (across * across + parallel * parallel));
}

/// Returns the weight of Schlick's approximation (1994), from 0 at normal incidence to 1.
template <class T>
RAYGATE_INLINE T schlick_weight(const T& cosine) {
  const T x = 1.0f - at_most(cosine, 1.0f), squared = x * x;
  return squared * squared * x;
}

/// Returns the unit vector `view` reflected about the unit normal `normal`.
template <class T>
RAYGATE_INLINE Triple<T> reflect(const Triple<T>& view, const Triple<T>& normal) {
  return normal * (2.0f * dot(view, normal)) - view;
}

/// The direction of light that travels along -view and is refracted by Snell's law at an interface
/// with the unit normal `normal`, which is on the side of `view`. `eta` is as in
/// transmitted_cosine_squared(). For total reflection, `exists` is not set.
template <class T>
struct Refraction {
  Triple<T> direction;
  MaskOf<T> exists;

  RAYGATE_INLINE Refraction(const Triple<T>& view, const Triple<T>& normal, const T& eta) {
    const T cosine = dot(view, normal), squared = transmitted_cosine_squared(cosine, eta);
    exists = squared > 0.0f;
    const T inverse = 1.0f / eta;
    direction = normal * (cosine * inverse - root(at_least(squared, 0.0f))) - view * inverse;
  }
};

/// A rough interface of many small smooth facets: the GGX distribution of their normals (Walter,
/// Marschner, Li and Torrance, "Microfacet models for refraction through rough surfaces", 2007),
/// with height-correlated masking and shadowing (Heitz, "Understanding the masking-shadowing
/// function", 2014). Single scattering: light that meets a second facet is lost. alpha is the
/// roughness, in [kLeast, 1]. Directions are unit vectors away from the surface.
template <class T>
struct Ggx {
  static constexpr float kLeast = 0x1p-10f;  // least alpha: float cosines resolve no narrower lobes

  Triple<T> normal;
  T squared;  ///< alpha^2

  Ggx() = default;
  RAYGATE_INLINE Ggx(const Triple<T>& surface_normal, const T& alpha)
      : normal(surface_normal), squared(alpha * alpha) {}

  /// Two directions and the facets that reflect one into the other.
  struct Pair {
    T d;         ///< D, the density of facets with the half vector as normal
    T cos_half;  ///< cosine between either direction and the half vector
  };
  [[nodiscard]] RAYGATE_INLINE Pair pair(const Triple<T>& a, const Triple<T>& b) const {
    const Triple<T> sum = a + b;
    const T size = dot(sum, sum), along = dot(normal, sum);
    // Computed from the vector: a sine from a cosine close to 1 is too coarse for narrow lobes.
    const Triple<T> across = sum - normal * along;
    const T ratio = size / (dot(across, across) + squared * along * along);
    return {kPerPi * squared * ratio * ratio, 0.5f * root(size)};
  }

  /// Returns sqrt(1 + alpha^2 tan^2) times the cosine, from which Smith's Lambda follows.
  [[nodiscard]] RAYGATE_INLINE T stretched(const T& cosine) const {
    return root(squared + (1.0f - squared) * cosine * cosine);
  }

  /// Returns G2 / (4 a b) for cosines a, b. The BRDF is this times D and the facets' reflectance.
  [[nodiscard]] RAYGATE_INLINE T visibility(const T& a, const T& b) const {
    return 0.5f / (a * stretched(b) + b * stretched(a));
  }

  /// Returns the pdf, per steradian, of directions that are reflected at a facet from sample().
  /// `view`: cosine of the view to the normal; `d`: Pair::d of view and direction.
  [[nodiscard]] RAYGATE_INLINE T reflection_pdf(const T& view, const T& d) const {
    return d * 0.5f / (view + stretched(view));
  }

  /// Returns G2 / G1: the unmasked fraction of the light that a sampled facet reflects.
  [[nodiscard]] RAYGATE_INLINE T g2_over_g1(const T& view, const T& light) const {
    return light * (view + stretched(view)) / (light * stretched(view) + view * stretched(light));
  }
  /// Returns G1: the unmasked fraction of the light that a sampled facet transmits. The masking of
  /// this light is independent of the masking of the view.
  [[nodiscard]] RAYGATE_INLINE T g1(const T& light) const {
    return 2.0f * light / (light + stretched(light));
  }

  /// Samples the normal of a facet from the distribution of visible normals ("Sampling visible GGX
  /// normals with spherical caps", Dupuy and Benyoub 2023).
  [[nodiscard]] RAYGATE_INLINE Triple<T> sample(const Triple<T>& view,
                                                const SquarePoint<T>& u) const {
    const Frame<T> frame(normal);
    const T alpha = root(squared);
    // Scaling by alpha across the normal turns the ellipsoid of facets into a hemisphere.
    const Triple<T> squeezed = normalized(Triple<T>{
        alpha * dot(frame.u, view), alpha * dot(frame.v, view), at_least(dot(normal, view), 0.0f)});
    const T z = (1.0f - u.x) * (1.0f + squeezed.z) - squeezed.z;
    const T across = root(at_least(1.0f - z * z, 0.0f));
    const auto turn = sine_cosine(wide(u.y));
    const Triple<T> cap =
        Triple<T>{across * narrow(turn.cosine), across * narrow(turn.sine), z} + squeezed;
    return normalized(frame.u * (alpha * cap.x) + frame.v * (alpha * cap.y) +
                      normal * at_least(cap.z, 0.0f));
  }
};

/// A table of two single-scattering albedos of GGX facets, by the cosine of a direction and alpha.
/// Entries are integrals over the visible facets. at() interpolates them bilinearly over the square
/// roots of cosine and alpha. The error is below 0.01 for cosines of at least 0.05.
class FacetAlbedo {
 public:
  /// Two albedos, each with one value per lane.
  template <class T>
  struct Shares {
    T first, second;
  };

  /// Returns the table of mirrors. `first`: for reflectance 1; `second`: for Schlick's weight.
  [[nodiscard]] static const FacetAlbedo& of_mirrors();
  /// Returns the table of glass with this index of refraction, reflection plus transmission:
  /// `first` for light from outside, `second` from inside.
  [[nodiscard]] static const FacetAlbedo& of_glass(float index);

  /// Returns the albedos at cosines and alphas in [0, 1].
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Shares<T> at(const T& cosine, const T& alpha) const {
    return at<T>([&](int) RAYGATE_BODY -> const FacetAlbedo& { return *this; }, cosine, alpha);
  }
  /// Returns albedos from several tables: lane k uses table_of(k).
  template <class T, class TableOf>
  [[nodiscard]] RAYGATE_INLINE static Shares<T> at(const TableOf& table_of, const T& cosine,
                                                   const T& alpha) {
    const Place<T> row(alpha), column(cosine);
    const auto share = [&](float Cell::*which) RAYGATE_BODY {
      const auto cell = [&](int below, int beside) RAYGATE_BODY {
        return gather<T>([&](int k) RAYGATE_BODY {
          return table_of(k).cells_[row.number[k] + below][column.number[k] + beside].*which;
        });
      };
      const T upper = between(cell(0, 0), cell(0, 1), column.rest);
      return between(upper, between(cell(1, 0), cell(1, 1), column.rest), row.rest);
    };
    return {share(&Cell::first), share(&Cell::second)};
  }
  /// Returns the means over all directions, weighted by the cosine.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Shares<T> mean(const T& alpha) const {
    const Place<T> row(alpha);
    const auto share = [&](float Cell::*which) RAYGATE_BODY {
      const auto cell = [&](int below) RAYGATE_BODY {
        return gather<T>([&](int k) RAYGATE_BODY { return means_[row.number[k] + below].*which; });
      };
      return between(cell(0), cell(1), row.rest);
    };
    return {share(&Cell::first), share(&Cell::second)};
  }

 private:
  static constexpr int kSize = 24;  // a multiple of kLanes
  using Cell = Shares<float>;
  /// A position between two rows or columns.
  template <class T>
  struct Place {
    LaneArray<std::int32_t, kLanesOf<T>> number;
    T rest;

    RAYGATE_INLINE explicit Place(const T& x) {
      const T at = root(x) * (kSize - 1.0f);
      const auto before = whole(at_most(at, kSize - 2.0f));
      number = unpack(before);
      rest = at - narrow(wide(before));
    }
  };
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static T between(const T& a, const T& b, const T& rest) {
    return a + (b - a) * rest;
  }

  explicit FacetAlbedo(float index);  // index of glass, or 0 for mirrors

  Cell cells_[kSize][kSize];  // by alpha, then by cosine
  Cell means_[kSize] = {};
};

}  // namespace raygate
