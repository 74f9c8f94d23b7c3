// Directions given by their angles around another one.
#pragma once

#include "host/base/lane_math.h"

namespace raygate {

/// Two unit vectors across the unit vector `axis` and each other: those of Duff and others
/// ("Building an orthonormal basis, revisited", 2017).
template <class T>
struct Frame {
  Triple<T> u, v;

  RAYGATE_INLINE explicit Frame(const Triple<T>& axis) {
    const T sign = choose(axis.z < 0.0f, spread<T>(-1.0f), spread<T>(1.0f));
    const T a = -1.0f / (sign + axis.z), b = axis.x * axis.y * a;
    u = {1.0f + sign * axis.x * axis.x * a, sign * b, -(sign * axis.x)};
    v = {b, sign + axis.y * axis.y * a, -axis.y};
  }
};

/// The unit vector that makes an angle with the unit vector `axis`, turned around it as the unit
/// vector (`turned_x`, `turned_y`) says.
template <class T>
RAYGATE_INLINE Triple<T> spherical_direction(const Triple<T>& axis, const T& cosine, const T& sine,
                                             const T& turned_x, const T& turned_y) {
  const Frame<T> frame(axis);
  return axis * cosine + frame.u * (sine * turned_x) + frame.v * (sine * turned_y);
}

}  // namespace raygate
