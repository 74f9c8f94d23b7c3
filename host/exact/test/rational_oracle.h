// Reference results for the predicates of exact.h, computed with GMP's rationals.
#pragma once

#include <gmpxx.h>

#include <array>

#include "host/exact/exact.h"

namespace raygate::test {

using Rational3 = std::array<mpq_class, 3>;

inline Rational3 rational(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
inline Rational3 minus(const Rational3& a, const Rational3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Rational3 cross(const Rational3& a, const Rational3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline mpq_class dot(const Rational3& a, const Rational3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns -1, 0 or 1.
inline int sign_of(__int128 x) { return (x > 0) - (x < 0); }

/// The definitions of exact.h in rational arithmetic. The code shares nothing with exact.cpp.
struct RationalOracle {
  Rational3 direction, v[3];

  RationalOracle(const ExactRay& ray, const Corners& t) : direction(rational(ray.direction)) {
    for (int k = 0; k < 3; ++k) v[k] = minus(rational(t[k]), rational(ray.origin));
  }
  [[nodiscard]] int side(int k) const {
    const Rational3 normal = cross(v[k], v[(k + 1) % 3]);
    int result = sgn(dot(direction, normal));
    for (int i = 0; i < 3 && result == 0; ++i) result = sgn(normal[i]);
    return result;
  }
  [[nodiscard]] mpq_class plane() const { return dot(v[0], cross(v[1], v[2])); }
  [[nodiscard]] mpq_class t() const {
    return plane() / dot(direction, cross(minus(v[1], v[0]), minus(v[2], v[0])));
  }
  [[nodiscard]] bool hit() const {
    const int d = sgn(plane());
    return d != 0 && side(0) == d && side(1) == d && side(2) == d;
  }
};

}  // namespace raygate::test
