// Triples: points, directions and colours in one or many lanes, and gathering of lanes.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <type_traits>

#include "host/base/lanes.h"

namespace raygate {

/// Three numbers: a point, a direction or a colour.
template <class T>
struct Triple {
  T x, y, z;

  RAYGATE_INLINE Triple operator+(const Triple& b) const { return {x + b.x, y + b.y, z + b.z}; }
  RAYGATE_INLINE Triple operator-(const Triple& b) const { return {x - b.x, y - b.y, z - b.z}; }
  RAYGATE_INLINE Triple operator-() const { return {-x, -y, -z}; }
  RAYGATE_INLINE Triple operator*(const Triple& b) const { return {x * b.x, y * b.y, z * b.z}; }
  RAYGATE_INLINE Triple operator*(const T& b) const { return {x * b, y * b, z * b}; }
};

template <class T>
RAYGATE_INLINE T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
RAYGATE_INLINE Triple<T> cross(const Triple<T>& u, const Triple<T>& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}
/// Returns u x v. Sets `size`, by component, to the sum of the magnitudes of the two products in u
/// x v. V is a Triple or a glm vector.
template <class V>
RAYGATE_INLINE V cross(const V& u, const V& v, V& size) {
  const V plus = {u.y * v.z, u.z * v.x, u.x * v.y}, minus = {v.y * u.z, v.z * u.x, v.x * u.y};
  size = {absolute(plus.x) + absolute(minus.x), absolute(plus.y) + absolute(minus.y),
          absolute(plus.z) + absolute(minus.z)};
  return plus - minus;
}
/// Returns the largest of three non-negative numbers.
template <class T>
RAYGATE_INLINE T largest(const Triple<T>& a) {
  return maximum(maximum(a.x, a.y), a.z);
}
template <class Mask, class T>
RAYGATE_INLINE Triple<T> choose(const Mask& mask, const Triple<T>& a, const Triple<T>& b) {
  return {choose(mask, a.x, b.x), choose(mask, a.y, b.y), choose(mask, a.z, b.z)};
}
template <class T>
RAYGATE_INLINE Triple<T> zero() {
  return {T{}, T{}, T{}};
}
template <class T, class Element>
RAYGATE_INLINE Triple<T> spread(const glm::vec<3, Element>& v) {
  return {spread<T>(v.x), spread<T>(v.y), spread<T>(v.z)};
}
template <class T>
RAYGATE_INLINE Triple<T> absolute(const Triple<T>& a) {
  return {absolute(a.x), absolute(a.y), absolute(a.z)};
}
template <class T>
RAYGATE_INLINE Triple<T> normalized(const Triple<T>& a) {
  return a * (1.0f / root(dot(a, a)));
}
/// Returns the largest magnitude of the components.
template <class T>
RAYGATE_INLINE T largest_size(const Triple<T>& a) {
  return maximum(absolute(a.z), maximum(absolute(a.y), absolute(a.x)));
}
/// Returns the direction multiplied by a power of two, so that its largest magnitude is in [1, 2).
/// Exact unless a component underflows. The largest magnitude must be normal and below 2^126.
template <class T>
RAYGATE_INLINE Triple<T> scaled(const Triple<T>& a) {
  constexpr std::int32_t kExponent = 0x7F800000, kOne = 0x3F800000;
  return a * float_of(2 * kOne - (bits_in(largest_size(a)) & kExponent));
}
template <class D>
RAYGATE_INLINE auto narrow(const Triple<D>& a) {
  using T = decltype(narrow(a.x));
  return Triple<T>{narrow(a.x), narrow(a.y), narrow(a.z)};
}
template <class T>
RAYGATE_INLINE Triple<WideOf<T>> wide(const Triple<T>& a) {
  return {wide(a.x), wide(a.y), wide(a.z)};
}

/// Gathers of(k) for each lane k. If of() returns a float, std::uint32_t, bool, glm::vec3 or
/// glm::dvec3, the result is numbers, words, a mask, a triple or a wide triple, respectively.
template <class T, class Of>
RAYGATE_INLINE auto gather(const Of& of) {
  constexpr int kCount = kLanesOf<T>;
  using Element = std::remove_cvref_t<decltype(of(0))>;
  if constexpr (std::is_same_v<Element, glm::vec3> || std::is_same_v<Element, glm::dvec3>) {
    using Number = typename Element::value_type;
    using Lanes = std::conditional_t<std::is_same_v<Number, float>, T, WideOf<T>>;
    alignas(sizeof(Number) * kCount) Number x[kCount], y[kCount], z[kCount];
    for (int k = 0; k < kCount; ++k) {
      const Element& v = of(k);
      x[k] = v.x;
      y[k] = v.y;
      z[k] = v.z;
    }
    return Triple<Lanes>{load<Lanes>(x), load<Lanes>(y), load<Lanes>(z)};
  } else if constexpr (std::is_same_v<Element, bool>) {
    return MaskOf<T>(gather<T>([&](int k) RAYGATE_BODY { return of(k) ? 1.0f : 0.0f; }) > 0.0f);
  } else {
    alignas(4 * kCount) Element values[kCount];
    for (int k = 0; k < kCount; ++k) values[k] = of(k);
    return load<std::conditional_t<std::is_same_v<Element, float>, T, WordOf<T>>>(values);
  }
}
template <class T, class Object, class Member>
RAYGATE_INLINE auto gather(const Object* const (&objects)[kLanesOf<T>], Member Object::*member) {
  return gather<T>([&](int k) RAYGATE_BODY -> const Member& { return objects[k]->*member; });
}

/// Triples as an array, for access by index.
template <int kCount>
struct TripleArray {
  LaneArray<float, kCount> x, y, z;
  RAYGATE_INLINE glm::vec3 operator[](int k) const { return {x[k], y[k], z[k]}; }
};
template <class T>
RAYGATE_INLINE TripleArray<kLanesOf<T>> unpack(const Triple<T>& triple) {
  return {unpack(triple.x), unpack(triple.y), unpack(triple.z)};
}

}  // namespace raygate
