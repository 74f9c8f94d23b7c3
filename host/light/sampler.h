// Numbers that look random but cover their square evenly: scrambled Sobol points.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace raygate {

/// A thorough mix of two words: every bit of the result depends on every bit of both.
[[nodiscard]] inline std::uint32_t mixed(std::uint32_t a, std::uint32_t b) {
  std::uint64_t x = (std::uint64_t{a} << 32 | b) + 0x9E3779B97F4A7C15u;  // splitmix64's finish
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
  x = (x ^ x >> 27) * 0x94D049BB133111EBu;
  return static_cast<std::uint32_t>((x ^ x >> 31) >> 32);
}

/// Points of the first two Sobol dimensions, a (0,2)-sequence: of any 2^k successive points from a
/// multiple of 2^k on, each elementary interval of area 2^-k holds one. Every stream has its own
/// Owen scrambling of both coordinates and of the order, so that streams are independent of each
/// other ("Practical Hash-based Owen Scrambling", Burley 2020, with the permutation of Laine and
/// Karras 2011). A point depends on nothing but stream and index.
class Sampler {
 public:
  /// `seed` of the whole picture; `pixel` names a pixel of the whole frame.
  Sampler(std::uint64_t seed, std::uint32_t pixel_x, std::uint32_t pixel_y)
      : key_(mixed(mixed(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)),
                   mixed(pixel_x, pixel_y))) {}

  /// Point `index` of the stream `dimension`, in [0, 1)^2.
  [[nodiscard]] glm::dvec2 operator()(std::uint32_t index, std::uint32_t dimension) const {
    const std::uint32_t key = mixed(key_, dimension);
    const std::uint32_t shuffled = scrambled(index, key);
    return {scrambled(reversed(shuffled), mixed(key, 1)) * 0x1p-32,
            scrambled(second_sobol(shuffled), mixed(key, 2)) * 0x1p-32};
  }

 private:
  static std::uint32_t reversed(std::uint32_t x) {
    x = x >> 16 | x << 16;
    x = (x >> 8 & 0x00FF00FFu) | (x & 0x00FF00FFu) << 8;
    x = (x >> 4 & 0x0F0F0F0Fu) | (x & 0x0F0F0F0Fu) << 4;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    return (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  }

  /// The second Sobol dimension: digit j is the sum, modulo 2, of the index's digits i times
  /// binomial(i, j). That is odd just where j's bits are among i's: five steps, one for each bit.
  static std::uint32_t second_sobol(std::uint32_t index) {
    index ^= index >> 1 & 0x55555555u;
    index ^= index >> 2 & 0x33333333u;
    index ^= index >> 4 & 0x0F0F0F0Fu;
    index ^= index >> 8 & 0x00FF00FFu;
    index ^= index >> 16 & 0x0000FFFFu;
    return reversed(index);
  }

  /// Owen's nested uniform scrambling: whether a bit is flipped depends on the bits above it.
  /// From the lowest bit upwards, each step below lets bits depend on lower ones only.
  static std::uint32_t scrambled(std::uint32_t x, std::uint32_t key) {
    x = reversed(x);
    x += key;
    x ^= x * 0x6C50B47Cu;  // even factors: a bit is changed by lower ones, never by itself
    x *= key | 1u;
    x ^= x * 0xB82F1E52u;
    x ^= x * 0xC7AFE638u;
    x ^= x * 0x8D22F6E6u;
    return reversed(x);
  }

  std::uint32_t key_;
};

}  // namespace raygate
