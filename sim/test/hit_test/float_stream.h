// Random input for the hit-test units, and expected results.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace raygate {

/// Returns the bits of `value`; for any NaN, those of the hardware's NaN.
inline std::uint32_t bits(float value) {
  return std::isnan(value) ? 0x7FC00000u : std::bit_cast<std::uint32_t>(value);
}

inline float from_bits(std::uint32_t word) { return std::bit_cast<float>(word); }

/// Returns P = d I / (I . N) for the words I, N, d. Operations are in the units' order.
inline std::array<std::uint32_t, 3> point_of(const std::array<std::uint32_t, 7>& words) {
  float dot = 0.0f;
  for (int k = 0; k < 3; ++k) dot += from_bits(words[3 + k]) * from_bits(words[k]);
  std::array<std::uint32_t, 3> point;
  for (int k = 0; k < 3; ++k) point[k] = bits(from_bits(words[6]) * from_bits(words[k]) / dot);
  return point;
}

/// Random floats of three kinds: ordinary numbers around 1; any bit pattern; special values (zeros,
/// subnormals, largest and smallest normal numbers, infinities and NaNs, of either sign). A test
/// has numbers of one kind or of all kinds; these four cases are equally frequent.
class FloatStream {
 public:
  explicit FloatStream(std::uint32_t seed) : random_(seed) {}

  /// Begins a test and chooses its kind of numbers.
  void next_test() { kind_ = random_() % 4; }

  float operator()() {
    constexpr std::uint32_t kSpecial[] = {0x00000000, 0x00000001, 0x007FFFFF, 0x00800000,
                                          0x3F800000, 0x7F7FFFFF, 0x7F800000, 0x7FC00001,
                                          0x7F800001, 0x00000123, 0x3F800001, 0x33800000};
    const unsigned kind = kind_ == 3 ? random_() % 3 : kind_;
    const std::uint32_t word = random_();
    if (kind == 0) return from_bits((word & 0x807FFFFF) | (120 + random_() % 16) << 23);
    if (kind == 1) return from_bits(word);
    return from_bits(kSpecial[random_() % std::size(kSpecial)] | (word & 0x80000000));
  }

  /// Returns the clocks to wait before a test: none before half of the tests, else up to 20.
  unsigned gap() { return random_() % 2 == 0 ? 0 : random_() % 21; }

 private:
  std::mt19937 random_;
  unsigned kind_ = 0;
};

}  // namespace raygate
