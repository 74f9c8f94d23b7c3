// What happens to light at the border of two clear media. T is float or FloatLanes.
#pragma once

#include "host/base/lane_math.h"

namespace raygate {

/// The square of the cosine beyond the border; negative at total reflection. `cosine` of the angle
/// of incidence, in [0, 1]; `eta` is the refraction index beyond the border over the one before it.
template <class T>
RAYGATE_INLINE T transmitted_cosine_squared(const T& cosine, const T& eta) {
  return 1.0f - (1.0f - cosine * cosine) / (eta * eta);
}

/// The share of unpolarised light that a smooth border reflects, by Fresnel's formulas: the mean
/// of both polarisations' |r|^2. 1 at total reflection.
template <class T>
RAYGATE_INLINE T fresnel_reflectance(const T& cosine, const T& eta) {
  const T squared = transmitted_cosine_squared(cosine, eta);
  const T beyond = root(at_least(squared, 0.0f));
  const T across = (cosine - eta * beyond) / (cosine + eta * beyond);
  const T parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  const T one = spread<T>(1.0f);
  return choose(squared <= 0.0f, one, 0.5f * (across * across + parallel * parallel));
}

/// Schlick's stand-in for it (1994) goes from the reflectance at normal incidence up to 1 at
/// grazing; this is how far.
template <class T>
RAYGATE_INLINE T schlick_weight(const T& cosine) {
  const T x = 1.0f - at_most(cosine, 1.0f), squared = x * x;
  return squared * squared * x;
}

/// The unit vector `view` mirrored: -view off a plane with the unit normal `normal`.
template <class T>
RAYGATE_INLINE Triple<T> reflect(const Triple<T>& view, const Triple<T>& normal) {
  return normal * (2.0f * dot(view, normal)) - view;
}

/// What runs against the unit vector `view` bent after Snell's law at a border with the unit normal
/// `normal`, on the side of `view`; eta as above. No direction where `exists` is not set: total
/// reflection.
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

}  // namespace raygate
