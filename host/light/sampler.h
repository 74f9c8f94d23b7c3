// Sampling: Owen-scrambled Sobol points, and directions around an axis.
#pragma once

#include <cstdint>

#include "host/base/elementary.h"

namespace raygate {

/// Returns a bijective hash of a word: every bit of the result depends on every bit of x. The
/// constants are Wellons' ("Prospecting for hash functions", 2018).
template <class W>
RAYGATE_INLINE W hash(W x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ x >> 16;
}

/// Returns a hash of two words.
template <class W, class V>
RAYGATE_INLINE W hash(const W& a, const V& b) {
  return hash<W>(hash<W>(a + 0x9E3779B9u) ^ b);
}

template <class W>
RAYGATE_INLINE W reversed_bits(W x) {
  x = x >> 16 | x << 16;
  x = (x >> 8 & 0x00FF00FFu) | (x & 0x00FF00FFu) << 8;
  x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  return (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
}

/// Computes Owen's nested uniform scrambling of a word with reversed bits: the more significant
/// bits determine whether a bit is flipped. Here, these are the lower bits of x.
template <class W>
RAYGATE_INLINE W owen_scramble(W x, const W& key) {
  x += key;
  x ^= x * 0x6C50B47Cu;  // even factors: each bit depends only on lower bits
  x *= key | 1u;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  return x ^ x * 0x8D22F6E6u;
}

/// Returns the second Sobol dimension with reversed bits: digit j is the sum over i, modulo 2, of
/// the index's digit i times binomial(i, j). The binomial is odd if the bits of j are a subset of
/// the bits of i. The sum takes five steps, one per bit of j.
template <class W>
RAYGATE_INLINE W second_sobol(W index) {
  index ^= index >> 1 & 0x55555555u;
  index ^= index >> 2 & 0x33333333u;
  index ^= index >> 4 & 0x0F0F0F0Fu;
  index ^= index >> 8 & 0x00FF00FFu;
  return index ^ (index >> 16 & 0x0000FFFFu);
}

/// A point of the unit square.
template <class T>
struct SquarePoint {
  T x, y;  ///< in [0, 1)
};

/// Returns point `index` of the stream `key`: the first two Sobol dimensions, a (0,2)-sequence. Of
/// 2^k successive points from a multiple of 2^k on, each elementary interval of area 2^-k contains
/// one. Each stream has its own Owen scrambling of both coordinates and of the index ("Practical
/// Hash-based Owen Scrambling", Burley 2020, with the permutation of Laine and Karras 2011).
template <class T>
RAYGATE_INLINE SquarePoint<T> sobol_point(const WordOf<T>& index, const WordOf<T>& key) {
  using Word = WordOf<T>;
  const Word shuffled = reversed_bits<Word>(owen_scramble<Word>(reversed_bits<Word>(index), key));
  const Word x = owen_scramble<Word>(shuffled, hash<Word>(key + 1u));
  const Word y = owen_scramble<Word>(second_sobol<Word>(shuffled), hash<Word>(key + 2u));
  return {unit_interval(reversed_bits<Word>(x)), unit_interval(reversed_bits<Word>(y))};
}

/// Returns the key of a pixel's streams, for the image's seed and the pixel's place in the frame.
[[nodiscard]] inline std::uint32_t pixel_key(std::uint64_t seed, std::uint32_t x, std::uint32_t y) {
  return hash(hash(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)),
              hash(x, y));
}

/// Returns point `index` of stream `stream` of `key`.
template <class T>
RAYGATE_INLINE SquarePoint<T> random_point(const WordOf<T>& index, const WordOf<T>& key,
                                           std::uint32_t stream) {
  return sobol_point<T>(index, hash(key, stream));
}

/// Two unit vectors perpendicular to the unit vector `axis` and to each other (Duff and others,
/// "Building an orthonormal basis, revisited", 2017).
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

/// Returns the unit vector at the angle with this cosine and sine to the unit vector `axis`.
/// `turns`, in [0, 1], is the azimuth around the axis in turns.
template <class T>
RAYGATE_INLINE Triple<T> spherical_direction(const Triple<T>& axis, const T& cosine, const T& sine,
                                             const T& turns) {
  const Frame<T> frame(axis);
  const auto turn = sine_cosine(wide(turns));
  return axis * cosine + frame.u * (sine * narrow(turn.cosine)) +
         frame.v * (sine * narrow(turn.sine));
}

}  // namespace raygate
