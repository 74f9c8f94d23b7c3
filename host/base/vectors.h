// Selection of vector code at run time: one source, compiled once for each instruction set.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace raygate {

/// Instruction sets, narrower first. All give the same bits: none fuses multiply and add.
enum class Vectors { kBaseline, kAvx2, kAvx512 };

[[nodiscard]] constexpr std::string_view name_of(Vectors vectors) {
  constexpr std::string_view kNames[] = {"baseline", "avx2", "avx512"};
  return kNames[static_cast<std::size_t>(vectors)];
}

// RAYGATE_BASELINE_ONLY makes compiling faster: in_vectors then only has the baseline version.
#ifdef RAYGATE_BASELINE_ONLY
#define RAYGATE_INLINE inline
#define RAYGATE_BODY
#else
#define RAYGATE_INLINE inline __attribute__((always_inline))
#define RAYGATE_BODY __attribute__((always_inline))
#if defined(__x86_64__) && defined(__GNUC__)
#define RAYGATE_AVX2 "avx2,bmi,bmi2,lzcnt,popcnt"  // the names of GCC and Clang
#define RAYGATE_AVX512 RAYGATE_AVX2 ",avx512f,avx512vl,avx512dq,avx512bw"
#endif
#endif

/// Returns the widest instruction set that both this build and this machine support.
[[nodiscard]] inline Vectors widest_vectors() {
#ifdef RAYGATE_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2")) {
    const bool has_512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    return has_512 ? Vectors::kAvx512 : Vectors::kAvx2;
  }
#endif
  return Vectors::kBaseline;
}

/// Returns the instruction sets that build and machine support, narrower first. For tests.
[[nodiscard]] inline std::span<const Vectors> machine_vectors() {
  static constexpr Vectors kAll[] = {Vectors::kBaseline, Vectors::kAvx2, Vectors::kAvx512};
  return std::span(kAll).first(static_cast<std::size_t>(widest_vectors()) + 1);
}

/// Returns the instruction set named by the environment variable RAYGATE_VECTORS, or the widest if
/// the variable is unset or empty. Throws std::runtime_error with one line for other names.
[[nodiscard]] inline Vectors wanted_vectors() {
  const char* const text = std::getenv("RAYGATE_VECTORS");
  if (text == nullptr || *text == '\0') return widest_vectors();
  std::string expected;
  for (const Vectors vectors : machine_vectors()) {
    if (text == name_of(vectors)) return vectors;
    expected += (expected.empty() ? "" : ", ") + std::string(name_of(vectors));
  }
  throw std::runtime_error("RAYGATE_VECTORS: found " + std::string(text) +
                           ", expected one that this machine has: " + expected);
}

namespace detail {
inline std::atomic<int> vectors_in_use{-1};
}  // namespace detail

/// Selects the instruction set of all threads. For tests; the machine must have it.
inline void use_vectors(Vectors vectors) { detail::vectors_in_use = static_cast<int>(vectors); }

/// Returns the selected instruction set; by default wanted_vectors().
[[nodiscard]] inline Vectors vectors_in_use() {
  const int vectors = detail::vectors_in_use.load(std::memory_order_relaxed);
  if (vectors >= 0) [[likely]]
    return static_cast<Vectors>(vectors);
  use_vectors(wanted_vectors());
  return vectors_in_use();
}

namespace detail {

template <class Body>
[[gnu::noinline]] auto in_baseline(const Body& body) {
  return body(std::integral_constant<Vectors, Vectors::kBaseline>{});
}
#ifdef RAYGATE_AVX2
template <class Body>
[[gnu::noinline, gnu::target(RAYGATE_AVX2)]] auto in_avx2(const Body& body) {
  return body(std::integral_constant<Vectors, Vectors::kAvx2>{});
}
template <class Body>
[[gnu::noinline, gnu::target(RAYGATE_AVX512)]] auto in_avx512(const Body& body) {
  return body(std::integral_constant<Vectors, Vectors::kAvx512>{});
}
#endif

}  // namespace detail

/// Calls body(code), compiled for the selected instruction set, and returns its result. The body is
///   [&](auto code) RAYGATE_BODY { ... }
/// where code() is a constant of type Vectors. Only functions that are inlined into the body are
/// compiled for the instruction set; mark them RAYGATE_INLINE. Functions that are not inlined must
/// not take or return vectors by value.
template <class Body>
auto in_vectors(const Body& body) {
  // Called in baseline builds, too, to reject an invalid RAYGATE_VECTORS.
  [[maybe_unused]] const Vectors vectors = vectors_in_use();
#ifdef RAYGATE_AVX2
  if (vectors == Vectors::kAvx512) return detail::in_avx512(body);
  if (vectors == Vectors::kAvx2) return detail::in_avx2(body);
#endif
  return detail::in_baseline(body);
}

}  // namespace raygate
