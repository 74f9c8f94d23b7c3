// Arithmetic written once for a float and for a vector of floats: masks, conversions, triples.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lanes.h"

namespace raygate {

using WordLanes = std::uint32_t __attribute__((vector_size(4 * kLanes), aligned(4 * kLanes)));
using DoubleLanes = double __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));
using LongLanes = std::int64_t __attribute__((vector_size(8 * kLanes), aligned(8 * kLanes)));

/// What goes with a number T: `float`, one lane, or FloatLanes, kLanes of them. Functions over T
/// are written once; what they do to a lane depends on nothing in another lane, so the bits are the
/// same for both. Comparisons give masks for choose(), & and |; `!` negates them.
template <class T>
struct LanesOf;

template <>
struct LanesOf<float> {
  static constexpr int kCount = 1;
  using Int = std::int32_t;
  using Word = std::uint32_t;
  using Wide = double;
  using Mask = bool;
};

template <>
struct LanesOf<FloatLanes> {
  static constexpr int kCount = kLanes;
  using Int = IntLanes;
  using Word = WordLanes;
  using Wide = DoubleLanes;
  using Mask = IntLanes;
};

template <class T>
using IntOf = typename LanesOf<T>::Int;
template <class T>
using WordOf = typename LanesOf<T>::Word;
template <class T>
using WideOf = typename LanesOf<T>::Wide;
template <class T>
using MaskOf = typename LanesOf<T>::Mask;

/// The lanes of T from an array, and back.
template <class T, class Element>
RAYGATE_INLINE T lanes_from(const Element* from) {
  T lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <class T, class Element>
RAYGATE_INLINE void lanes_to(Element* to, const T& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// x in all lanes.
template <class T, class Element>
RAYGATE_INLINE T spread(Element x) {
  return T{} + x;
}

RAYGATE_INLINE float choose(bool mask, float a, float b) { return mask ? a : b; }
RAYGATE_INLINE double choose(bool mask, double a, double b) { return mask ? a : b; }
RAYGATE_INLINE std::uint32_t choose(bool mask, std::uint32_t a, std::uint32_t b) {
  return mask ? a : b;
}
RAYGATE_INLINE FloatLanes choose(const IntLanes& mask, const FloatLanes& a, const FloatLanes& b) {
  return reinterpret_cast<FloatLanes>((reinterpret_cast<IntLanes>(a) & mask) |
                                      (reinterpret_cast<IntLanes>(b) & ~mask));
}
RAYGATE_INLINE WordLanes choose(const IntLanes& mask, const WordLanes& a, const WordLanes& b) {
  const auto bits = reinterpret_cast<WordLanes>(mask);
  return (a & bits) | (b & ~bits);
}
RAYGATE_INLINE DoubleLanes choose(const IntLanes& mask, const DoubleLanes& a,
                                  const DoubleLanes& b) {
  const auto bits = __builtin_convertvector(mask, LongLanes);
  return reinterpret_cast<DoubleLanes>((reinterpret_cast<LongLanes>(a) & bits) |
                                       (reinterpret_cast<LongLanes>(b) & ~bits));
}

/// Whether any lane is set.
RAYGATE_INLINE bool any(bool mask) { return mask; }
RAYGATE_INLINE bool any(const IntLanes& mask) { return sign_mask(mask) != 0; }

/// Numbers of another kind: rounded to nearest, or cut off where they become integers.
RAYGATE_INLINE double wide(float x) { return x; }
RAYGATE_INLINE double wide(std::int32_t x) { return x; }
RAYGATE_INLINE DoubleLanes wide(const FloatLanes& x) {
  return __builtin_convertvector(x, DoubleLanes);
}
RAYGATE_INLINE DoubleLanes wide(const IntLanes& x) {
  return __builtin_convertvector(x, DoubleLanes);
}
RAYGATE_INLINE float narrow(double x) { return static_cast<float>(x); }
RAYGATE_INLINE FloatLanes narrow(const DoubleLanes& x) {
  return __builtin_convertvector(x, FloatLanes);
}
RAYGATE_INLINE std::int32_t whole(float x) { return static_cast<std::int32_t>(x); }
RAYGATE_INLINE IntLanes whole(const FloatLanes& x) { return __builtin_convertvector(x, IntLanes); }

/// The same bits as another kind of number.
RAYGATE_INLINE std::int32_t bits_in(float x) { return std::bit_cast<std::int32_t>(x); }
RAYGATE_INLINE IntLanes bits_in(const FloatLanes& x) { return reinterpret_cast<IntLanes>(x); }
RAYGATE_INLINE float float_of(std::int32_t bits) { return std::bit_cast<float>(bits); }
RAYGATE_INLINE FloatLanes float_of(const IntLanes& bits) {
  return reinterpret_cast<FloatLanes>(bits);
}

/// A random word as a number in [0, 1): its upper 24 bits, each as they are.
RAYGATE_INLINE float unit_interval(std::uint32_t word) {
  return static_cast<float>(static_cast<std::int32_t>(word >> 8)) * 0x1p-24f;
}
RAYGATE_INLINE FloatLanes unit_interval(const WordLanes& word) {
  return __builtin_convertvector(reinterpret_cast<IntLanes>(word >> 8), FloatLanes) * 0x1p-24f;
}

/// Square roots, correctly rounded.
RAYGATE_INLINE float root(float x) { return std::sqrt(x); }
RAYGATE_INLINE double root(double x) { return std::sqrt(x); }
RAYGATE_INLINE FloatLanes root(const FloatLanes& x) {
  FloatLanes result;
  for (int k = 0; k < kLanes; ++k) result[k] = std::sqrt(x[k]);
  return result;
}
RAYGATE_INLINE DoubleLanes root(const DoubleLanes& x) {
  DoubleLanes result;
  for (int k = 0; k < kLanes; ++k) result[k] = std::sqrt(x[k]);
  return result;
}

template <class T>
RAYGATE_INLINE T minimum(const T& a, const T& b) {
  return choose(a < b, a, b);
}
template <class T>
RAYGATE_INLINE T maximum(const T& a, const T& b) {
  return choose(a > b, a, b);
}
template <class T>
RAYGATE_INLINE T at_least(const T& x, float least) {
  return maximum(x, spread<T>(least));
}
template <class T>
RAYGATE_INLINE T at_most(const T& x, float most) {
  return minimum(x, spread<T>(most));
}
template <class T>
RAYGATE_INLINE T absolute(const T& x) {
  T result;
  magnitude(x, result);
  return result;
}

/// Three numbers: a place, a direction or a colour.
template <class T>
struct Triple {
  T x, y, z;
};

template <class T>
RAYGATE_INLINE Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
RAYGATE_INLINE Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
RAYGATE_INLINE Triple<T> operator-(const Triple<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
RAYGATE_INLINE Triple<T> operator*(const Triple<T>& a, const Triple<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
RAYGATE_INLINE Triple<T> operator*(const Triple<T>& a, const T& b) {
  return {a.x * b, a.y * b, a.z * b};
}
template <class T>
RAYGATE_INLINE T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// The largest of three numbers that are not negative.
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
template <class T>
RAYGATE_INLINE Triple<T> spread(const glm::vec3& v) {
  return {spread<T>(v.x), spread<T>(v.y), spread<T>(v.z)};
}
template <class T>
RAYGATE_INLINE Triple<T> normalized(const Triple<T>& a) {
  return a * (1.0f / root(dot(a, a)));
}
/// A direction scaled as is_scaled wants it: by a power of two, which rounds nothing. Its largest
/// component is to be a normal number below 2^126.
template <class T>
RAYGATE_INLINE Triple<T> scaled(const Triple<T>& a) {
  constexpr std::int32_t kExponent = 0x7F800000, kOne = 0x3F800000;
  const T size = maximum(maximum(absolute(a.x), absolute(a.y)), absolute(a.z));
  return a * float_of(2 * kOne - (bits_in(size) & kExponent));
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

/// What of(k) gives for each lane k: a number, a word, a mask or a triple, as it gives a float, a
/// std::uint32_t, a bool or a glm::vec3.
template <class T, class Of>
RAYGATE_INLINE auto gather(const Of& of) {
  constexpr int kCount = LanesOf<T>::kCount;
  using Element = std::remove_cvref_t<decltype(of(0))>;
  if constexpr (std::is_same_v<Element, glm::vec3>) {
    alignas(4 * kCount) float x[kCount], y[kCount], z[kCount];
    for (int k = 0; k < kCount; ++k) {
      const glm::vec3& v = of(k);
      x[k] = v.x;
      y[k] = v.y;
      z[k] = v.z;
    }
    return Triple<T>{lanes_from<T>(x), lanes_from<T>(y), lanes_from<T>(z)};
  } else if constexpr (std::is_same_v<Element, bool>) {
    return MaskOf<T>(gather<T>([&](int k) RAYGATE_BODY { return of(k) ? 1.0f : 0.0f; }) > 0.0f);
  } else {
    alignas(4 * kCount) Element values[kCount];
    for (int k = 0; k < kCount; ++k) values[k] = of(k);
    return lanes_from<std::conditional_t<std::is_same_v<Element, float>, T, WordOf<T>>>(values);
  }
}
/// The same member of each lane's object.
template <class T, class Object, class Member>
RAYGATE_INLINE auto gather(const Object* const (&objects)[LanesOf<T>::kCount],
                           Member Object::*member) {
  return gather<T>([&](int k) RAYGATE_BODY -> const Member& { return objects[k]->*member; });
}

/// Lanes to be read one by one.
template <class Element, int kCount>
struct LaneArray {
  alignas(sizeof(Element) * kCount) Element values[kCount];
  RAYGATE_INLINE Element operator[](int k) const { return values[k]; }
};
template <int kCount>
struct TripleArray {
  LaneArray<float, kCount> x, y, z;
  RAYGATE_INLINE glm::vec3 operator[](int k) const { return {x[k], y[k], z[k]}; }
};
template <class Element>
RAYGATE_INLINE LaneArray<Element, 1> unpack(Element x) requires std::is_arithmetic_v<Element> {
  return {{x}};
}
template <class Lanes>
RAYGATE_INLINE auto unpack(const Lanes& lanes) requires(!std::is_arithmetic_v<Lanes>) {
  LaneArray<std::remove_cvref_t<decltype(lanes[0])>, kLanes> out;
  lanes_to(out.values, lanes);
  return out;
}
template <class T>
RAYGATE_INLINE TripleArray<LanesOf<T>::kCount> unpack(const Triple<T>& triple) {
  return {unpack(triple.x), unpack(triple.y), unpack(triple.z)};
}

}  // namespace raygate
