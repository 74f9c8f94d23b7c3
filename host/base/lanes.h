// Lanes: vectors of eight floats or integers and operations on them, compiled for each instruction
// set by in_vectors (host/base/vectors.h).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#if defined(__SSE__)
#include <immintrin.h>
#endif

#include "host/base/vectors.h"

namespace raygate {

/// Rays are handled eight at a time: one AVX register of floats.
inline constexpr int kLanes = 8;

/// A set of lanes: bit k stands for lane k.
using LaneMask = std::uint32_t;

/// GCC's and Clang's vector types: element-wise arithmetic, and comparisons giving 0 or -1. Passed
/// around by reference only, so that no calling convention depends on the machine; aligned
/// explicitly, as the compiler's own choice does.
using FloatLanes = float __attribute__((vector_size(4 * kLanes), aligned(4 * kLanes)));
using IntLanes = std::int32_t __attribute__((vector_size(4 * kLanes), aligned(4 * kLanes)));

RAYGATE_INLINE void load_lanes(const float* from, FloatLanes& to) {
  std::memcpy(&to, from, sizeof to);
}

/// Lanes where a comparison held, for two comparisons at once: the first in bits 0-7, the second
/// in bits 8-15.
RAYGATE_INLINE std::uint32_t mask_of(const IntLanes& first, const IntLanes& second) {
  constexpr IntLanes kFirst = {1, 2, 4, 8, 16, 32, 64, 128};
  constexpr IntLanes kSecond = {256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  IntLanes bits = (first & kFirst) | (second & kSecond);
  bits |= __builtin_shufflevector(bits, bits, 4, 5, 6, 7, 0, 1, 2, 3);
  bits |= __builtin_shufflevector(bits, bits, 2, 3, 0, 1, 6, 7, 4, 5);
  bits |= __builtin_shufflevector(bits, bits, 1, 0, 3, 2, 5, 4, 7, 6);
  return static_cast<std::uint32_t>(bits[0]);
}

/// The lanes whose sign bit is set; the fitting code is the one it is inlined into.
template <Vectors kCode = Vectors::kBaseline>
RAYGATE_INLINE LaneMask sign_mask(const IntLanes& lanes) {
#ifdef RAYGATE_AVX2
  if constexpr (kCode != Vectors::kBaseline) {
    return static_cast<LaneMask>(__builtin_ia32_movmskps256(reinterpret_cast<FloatLanes>(lanes)));
  }
#endif
#if defined(__SSE__)
  const auto low = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3);
  const auto high = __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
  return static_cast<LaneMask>(_mm_movemask_ps(reinterpret_cast<__m128>(low)) |
                               _mm_movemask_ps(reinterpret_cast<__m128>(high)) << 4);
#else
  return mask_of(lanes >> 31, IntLanes{});
#endif
}

/// -1 in the lanes of the mask, 0 in the others.
RAYGATE_INLINE void lanes_of(LaneMask mask, IntLanes& lanes) {
  constexpr IntLanes kBit = {1, 2, 4, 8, 16, 32, 64, 128};
  lanes = ((IntLanes{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
}

/// The largest lane; no NaN.
RAYGATE_INLINE float largest_of(const FloatLanes& lanes) {
  FloatLanes x = lanes, other = __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5);
  x = x > other ? x : other;
  other = __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6);
  x = x > other ? x : other;
  return x[0];
}

/// Four floats at a time: one SSE register, for the triangles of a leaf.
inline constexpr int kQuad = 4;
using FloatQuad = float __attribute__((vector_size(4 * kQuad), aligned(4 * kQuad)));
using IntQuad = std::int32_t __attribute__((vector_size(4 * kQuad), aligned(4 * kQuad)));

/// Four doubles at a time: one AVX register.
using DoubleQuad = double __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));
using LongQuad = std::int64_t __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));

RAYGATE_INLINE void load_quad(const float* from, FloatQuad& to) {
  std::memcpy(&to, from, sizeof to);
}

/// Four floats as doubles: GCC 12 makes four instructions of what is one.
template <Vectors kCode>
RAYGATE_INLINE void widen(const FloatQuad& from, DoubleQuad& to) {
#ifdef RAYGATE_AVX2
  if constexpr (kCode != Vectors::kBaseline) {
    to = __builtin_ia32_cvtps2pd256(from);
    return;
  }
#endif
  to = __builtin_convertvector(from, DoubleQuad);
}

/// As many floats as fit a register: what is wider, GCC takes apart word by word to compare it.
template <Vectors kCode>
struct NativeFloatsOf {
  using Type = FloatLanes;
};
template <>
struct NativeFloatsOf<Vectors::kBaseline> {
  using Type = FloatQuad;
};
template <Vectors kCode>
using NativeFloats = typename NativeFloatsOf<kCode>::Type;

/// Element i of row k becomes element k of row i.
RAYGATE_INLINE void transpose(FloatQuad (&rows)[kQuad]) {
  const FloatQuad ab_low = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
  const FloatQuad ab_high = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7);
  const FloatQuad cd_low = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
  const FloatQuad cd_high = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
  rows[0] = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  rows[2] = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  rows[3] = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

RAYGATE_INLINE void transpose(DoubleQuad (&rows)[kQuad]) {
  const DoubleQuad ab_even = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
  const DoubleQuad ab_odd = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
  const DoubleQuad cd_even = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
  const DoubleQuad cd_odd = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// The elements whose sign bit is set.
RAYGATE_INLINE LaneMask sign_mask(const IntQuad& quad) {
#if defined(__SSE__)
  return static_cast<LaneMask>(_mm_movemask_ps(reinterpret_cast<__m128>(quad)));
#else
  LaneMask mask = 0;
  for (int i = 0; i < kQuad; ++i) mask |= static_cast<LaneMask>(quad[i] < 0) << i;
  return mask;
#endif
}

template <Vectors kCode>
RAYGATE_INLINE LaneMask sign_mask(const IntQuad& quad) {
  return sign_mask(quad);
}

/// |x|, of a number or of vectors of floats or doubles.
template <class T>
RAYGATE_INLINE void magnitude(const T& x, T& result) {
  if constexpr (std::is_arithmetic_v<T>) {
    result = std::abs(x);
  } else {
    using Bits = decltype(x < x);
    using Word = std::remove_cvref_t<decltype(Bits{}[0])>;
    result = reinterpret_cast<T>(reinterpret_cast<Bits>(x) & std::numeric_limits<Word>::max());
  }
}

/// u x v, and for each component the sum of the magnitudes of its two products.
template <class T>
RAYGATE_INLINE void cross(const T (&u)[3], const T (&v)[3], T (&value)[3], T (&size)[3]) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const T plus = u[i] * v[j], minus = u[j] * v[i];
    T plus_size, minus_size;
    magnitude(plus, plus_size);
    magnitude(minus, minus_size);
    value[k] = plus - minus;
    size[k] = plus_size + minus_size;
  }
}

/// The same bits as integers, and back.
RAYGATE_INLINE void bits_of(const FloatLanes& lanes, IntLanes& bits) {
  bits = reinterpret_cast<IntLanes>(lanes);
}
RAYGATE_INLINE void floats_of(const IntLanes& bits, FloatLanes& lanes) {
  lanes = reinterpret_cast<FloatLanes>(bits);
}

}  // namespace raygate
