// Lanes: vectors of any element type and count, and operations that work on vectors and single
// numbers. in_vectors (host/base/vectors.h) compiles them for each instruction set.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>
#include <utility>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "host/base/vectors.h"

// All functions on vectors are inlined, so the calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace raygate {

/// Number of rays handled at a time: as many as an AVX register has floats.
inline constexpr int kLanes = 8;
/// Number of triangles tested at a time: an SSE register has 4 floats, an AVX register 4 doubles.
inline constexpr int kQuad = 4;

/// A set of lanes; bit k belongs to lane k.
using LaneMask = std::uint32_t;

/// The indices of the set bits of a word, lowest first, for range-based loops.
template <class Word>
class SetBits {
 public:
  RAYGATE_INLINE explicit SetBits(Word word) : left_(word) {}
  RAYGATE_INLINE SetBits begin() const { return *this; }
  RAYGATE_INLINE std::default_sentinel_t end() const { return {}; }
  RAYGATE_INLINE bool operator==(std::default_sentinel_t) const { return left_ == 0; }
  RAYGATE_INLINE int operator*() const { return std::countr_zero(left_); }
  RAYGATE_INLINE void operator++() { left_ &= left_ - 1; }

 private:
  Word left_;
};

/// GCC's and Clang's vector types: element-wise arithmetic, comparisons giving 0 or -1, and
/// `mask ? a : b`. Functions that are not inlined must not take or return vectors, because calling
/// convention and alignment would depend on the machine.
template <class Element, int kCount>
using Vec [[gnu::vector_size(sizeof(Element) * kCount), gnu::aligned(sizeof(Element) * kCount)]] =
    Element;

using FloatLanes = Vec<float, kLanes>;
using IntLanes = Vec<std::int32_t, kLanes>;
using FloatQuad = Vec<float, kQuad>;
using IntQuad = Vec<std::int32_t, kQuad>;
using DoubleQuad = Vec<double, kQuad>;
using LongQuad = Vec<std::int64_t, kQuad>;

namespace detail {
template <class Element, int kCount>
struct VecOf {
  using Type = Vec<Element, kCount>;
};
template <class Element>
struct VecOf<Element, 1> {
  using Type = Element;
};
}  // namespace detail

// Operations on T, which is a number (one lane) or a vector. No lane depends on another one, so
// results have the same bits for any number of lanes. Comparisons return masks for choose(), & and
// |; `!` negates them.

/// Result type of comparisons of T.
template <class T>
using MaskOf = std::remove_cvref_t<decltype(std::declval<T>() < std::declval<T>())>;
/// Number of lanes of T.
template <class T>
inline constexpr int kLanesOf = 1;
template <class T>
requires requires(const T& x) { x[0]; }
inline constexpr int kLanesOf<T> = sizeof(T) / sizeof(std::declval<T&>()[0]);
/// Vector of another element type with the same number of lanes.
template <class T, class Element>
using Like = typename detail::VecOf<Element, kLanesOf<T>>::Type;
template <class T>
using IntOf = Like<T, std::int32_t>;
template <class T>
using WordOf = Like<T, std::uint32_t>;
template <class T>
using WideOf = Like<T, double>;

/// Load lanes from an array or another object, and store them.
template <class T, class From>
RAYGATE_INLINE T load(const From* from) {
  T lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <class T, class To>
RAYGATE_INLINE void store(To* to, const T& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

/// Returns x in all lanes.
template <class T, class Element>
RAYGATE_INLINE T spread(Element x) {
  return T{} + x;
}

/// Converts lanes to another element type: to floats rounding to nearest, to integers towards 0.
template <class To, class T>
RAYGATE_INLINE To convert(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return static_cast<To>(x);
  } else {
    return __builtin_convertvector(x, To);
  }
}
template <class T>
RAYGATE_INLINE WideOf<T> wide(const T& x) {
  return convert<WideOf<T>>(x);
}
template <class T>
RAYGATE_INLINE Like<T, float> narrow(const T& x) {
  return convert<Like<T, float>>(x);
}
template <class T>
RAYGATE_INLINE IntOf<T> whole(const T& x) {
  return convert<IntOf<T>>(x);
}

/// Reinterprets the bits as another element type.
template <class T>
RAYGATE_INLINE IntOf<T> bits_in(const T& x) {
  return __builtin_bit_cast(IntOf<T>, x);
}
template <class T>
RAYGATE_INLINE Like<T, float> float_of(const T& bits) {
  return __builtin_bit_cast(Like<T, float>, bits);
}

/// Returns lanes of a where the mask is set, of b elsewhere. Uses bit operations, because GCC 12
/// compares the mask with 0 again for `mask ? a : b`.
template <class Mask, class T>
RAYGATE_INLINE T choose(const Mask& mask, const T& a, const T& b) {
  if constexpr (std::is_arithmetic_v<T>) {
    return mask ? a : b;
  } else {
    using Bits = MaskOf<T>;
    const Bits bits = convert<Bits>(mask);
    return __builtin_bit_cast(
        T, (__builtin_bit_cast(Bits, a) & bits) | (__builtin_bit_cast(Bits, b) & ~bits));
  }
}
template <class T>
RAYGATE_INLINE T minimum(const T& a, const T& b) {
  return a < b ? a : b;
}
template <class T>
RAYGATE_INLINE T maximum(const T& a, const T& b) {
  return a > b ? a : b;
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
  if constexpr (std::is_arithmetic_v<T>) {
    return std::abs(x);
  } else {
    using Word = std::remove_cvref_t<decltype(MaskOf<T>{}[0])>;
    return reinterpret_cast<T>(reinterpret_cast<MaskOf<T>>(x) & std::numeric_limits<Word>::max());
  }
}

/// Returns correctly rounded square roots.
template <class T>
RAYGATE_INLINE T root(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return std::sqrt(x);
  } else {
    T result;
    for (int k = 0; k < kLanesOf<T>; ++k) result[k] = std::sqrt(x[k]);
    return result;
  }
}

/// Converts the upper 24 bits of a random word to a number in [0, 1).
template <class W>
RAYGATE_INLINE Like<W, float> unit_interval(const W& word) {
  return narrow(__builtin_bit_cast(IntOf<W>, word >> 8)) * 0x1p-24f;
}

/// Returns the largest lane; no lane may be NaN.
RAYGATE_INLINE float largest_of(const FloatLanes& lanes) {
  FloatLanes x = maximum(lanes, __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7, 0, 1, 2, 3));
  x = maximum(x, __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5));
  x = maximum(x, __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6));
  return x[0];
}

/// Split lanes into 0 to 3 and 4 to 7, and join them.
template <class Lanes>
RAYGATE_INLINE auto low_half(const Lanes& x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3);
}
template <class Lanes>
RAYGATE_INLINE auto high_half(const Lanes& x) {
  return __builtin_shufflevector(x, x, 4, 5, 6, 7);
}
template <class Quad>
RAYGATE_INLINE auto join(const Quad& low, const Quad& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

#ifdef RAYGATE_AVX2
// Instructions that compilers do not generate from vector code. These functions are not marked
// always_inline: only functions compiled for the same instruction set can inline them.
[[gnu::target("avx")]] inline LaneMask avx_sign_mask(const FloatLanes& x) {
  return static_cast<LaneMask>(__builtin_ia32_movmskps256(x));
}
[[gnu::target("avx2")]] inline void avx2_permute(IntLanes& x, const IntLanes& lanes) {
  x = __builtin_ia32_permvarsi256(x, lanes);
}
#endif

/// Returns the lanes whose sign bit is set. kCode is the instruction set of the calling function.
template <Vectors kCode = Vectors::kBaseline>
RAYGATE_INLINE LaneMask sign_mask(const IntQuad& quad) {
#if defined(__SSE__)
  return static_cast<LaneMask>(_mm_movemask_ps(reinterpret_cast<__m128>(quad)));
#else
  constexpr IntQuad kBit = {1, 2, 4, 8};
  const IntQuad bits = (quad >> 31) & kBit;
  return static_cast<LaneMask>((bits[0] | bits[1]) | (bits[2] | bits[3]));
#endif
}
template <Vectors kCode = Vectors::kBaseline>
RAYGATE_INLINE LaneMask sign_mask(const IntLanes& lanes) {
#ifdef RAYGATE_AVX2
  if constexpr (kCode != Vectors::kBaseline) {
    return avx_sign_mask(reinterpret_cast<FloatLanes>(lanes));
  }
#endif
  return sign_mask(IntQuad(low_half(lanes))) | sign_mask(IntQuad(high_half(lanes))) << 4;
}

RAYGATE_INLINE bool any(bool mask) { return mask; }
RAYGATE_INLINE bool any(const IntLanes& mask) { return sign_mask(mask) != 0; }

/// Returns -1 in the lanes of the mask, 0 in the others.
RAYGATE_INLINE IntLanes lanes_of(LaneMask mask) {
  constexpr IntLanes kBit = {1, 2, 4, 8, 16, 32, 64, 128};
  return ((IntLanes{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
}

/// Converts four floats to doubles in one instruction; GCC 12 would use four.
template <Vectors kCode>
RAYGATE_INLINE DoubleQuad widen(const FloatQuad& from) {
#if defined(RAYGATE_AVX2) && !defined(__clang__)
  if constexpr (kCode != Vectors::kBaseline) return __builtin_ia32_cvtps2pd256(from);
#endif
  return wide(from);
}

/// The vector of floats that fills a register of kCode. GCC compares wider vectors word by word.
template <Vectors kCode>
using NativeFloats = Vec<float, kCode == Vectors::kBaseline ? kQuad : kLanes>;
/// Returns quad(0) if T has four lanes, or quad(0) and quad(1) joined if it has eight.
template <class T, class Quad>
RAYGATE_INLINE T joined(const Quad& quad) {
  if constexpr (kLanesOf<T> == kQuad) {
    return quad(0);
  } else {
    return join(quad(0), quad(1));
  }
}

/// Returns, for each quad of lanes, elements i and j of a's quad, then i and j of b's quad.
template <int i, int j, class T>
RAYGATE_INLINE T pick(const T& a, const T& b) {
  if constexpr (kLanesOf<T> == kQuad) {
    return __builtin_shufflevector(a, b, i, j, 4 + i, 4 + j);
  } else {
    return __builtin_shufflevector(a, b, i, j, 8 + i, 8 + j, 4 + i, 4 + j, 12 + i, 12 + j);
  }
}

/// Transposes four rows: in each quad of lanes, element i of row k becomes element k of row i.
template <class T>
RAYGATE_INLINE void transpose(T (&rows)[kQuad]) {
  const T ab[2] = {pick<0, 1>(rows[0], rows[1]), pick<2, 3>(rows[0], rows[1])};
  const T cd[2] = {pick<0, 1>(rows[2], rows[3]), pick<2, 3>(rows[2], rows[3])};
  for (int i = 0; i < 2; ++i) {
    rows[2 * i] = pick<0, 2>(ab[i], cd[i]);
    rows[2 * i + 1] = pick<1, 3>(ab[i], cd[i]);
  }
}
RAYGATE_INLINE void transpose(FloatLanes (&rows)[kLanes]) {
  FloatLanes halves[2][kQuad];  // of rows 0 to 3, and 4 to 7
  for (int i = 0; i < kLanes; ++i) halves[i / kQuad][i % kQuad] = rows[i];
  transpose(halves[0]);
  transpose(halves[1]);
  for (int i = 0; i < kQuad; ++i) {
    const FloatLanes &low = halves[0][i], &high = halves[1][i];
    rows[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 8, 9, 10, 11);
    rows[i + kQuad] = __builtin_shufflevector(low, high, 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Load one record per lane, or store the records of the first `count` lanes. A record is kWords
/// consecutive floats or 32-bit words; words[i] holds word i of each lane's record.
template <class T, std::size_t kWords, class Record>
RAYGATE_INLINE void load_records(const Record* const (&records)[kLanesOf<T>], T (&words)[kWords]) {
  static_assert(sizeof(Record) == 4 * kWords && kWords % kLanes == 0);
  if constexpr (kLanesOf<T> == 1) {
    std::memcpy(words, records[0], sizeof words);
  } else {
    for (std::size_t first = 0; first < kWords; first += kLanes) {
      T rows[kLanes];
      for (int k = 0; k < kLanes; ++k) {
        rows[k] = load<T>(reinterpret_cast<const float*>(records[k]) + first);
      }
      transpose(rows);
      for (int k = 0; k < kLanes; ++k) words[first + k] = rows[k];
    }
  }
}
template <class T, std::size_t kWords, class Record>
RAYGATE_INLINE void store_records(const T (&words)[kWords], Record* const (&records)[kLanesOf<T>],
                                  int count) {
  static_assert(sizeof(Record) == 4 * kWords && kWords % kLanes == 0);
  if constexpr (kLanesOf<T> == 1) {
    std::memcpy(static_cast<void*>(records[0]), words, sizeof words);
  } else {
    for (std::size_t first = 0; first < kWords; first += kLanes) {
      T rows[kLanes];
      for (int k = 0; k < kLanes; ++k) rows[k] = words[first + k];
      transpose(rows);
      for (int k = 0; k < count; ++k) {
        store(reinterpret_cast<char*>(records[k]) + 4 * first, rows[k]);
      }
    }
  }
}

/// Lanes as an array, for access by index.
template <class Element, int kCount>
struct LaneArray {
  alignas(sizeof(Element) * kCount) Element values[kCount];
  RAYGATE_INLINE Element operator[](int k) const { return values[k]; }
};
template <class T>
RAYGATE_INLINE auto unpack(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return LaneArray<T, 1>{{x}};
  } else {
    LaneArray<std::remove_cvref_t<decltype(x[0])>, kLanesOf<T>> out;
    store(out.values, x);
    return out;
  }
}

}  // namespace raygate
