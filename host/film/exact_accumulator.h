// Exact accumulator: a sum without rounding, the same in whatever order its numbers come.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace raygate {

/// A sum of numbers in 192 bits, two's complement, with a unit of 2^-96. What a number has below
/// that is cut off; numbers count as at most 2^63 in size, so that 2^31 of them do not overflow. A
/// NaN counts as 0.
class ExactAccumulator {
 public:
  static_assert(std::endian::native == std::endian::little, "files have its words");

  void add(double number) {
    const double size = std::min(std::abs(number), kMost);
    if (!(size >= kLeast)) return;
    const auto bits = std::bit_cast<std::uint64_t>(size);
    std::uint64_t significand = (bits & (kHidden - 1)) | kHidden;
    int shift = static_cast<int>(bits >> 52) - 1075 + kFraction;
    if (shift < 0) {
      significand >>= -shift;
      shift = 0;
    }
    const int word = shift / 64, within = shift % 64;
    ExactAccumulator term;
    term.words_[word] = significand << within;
    if (within != 0 && word < 2) term.words_[word + 1] = significand >> (64 - within);
    if (number < 0.0) term = -term;
    *this += term;
  }

  ExactAccumulator& operator+=(const ExactAccumulator& other) {
    std::uint64_t carry = 0;
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t with_carry = words_[i] + carry;
      words_[i] = with_carry + other.words_[i];
      carry = static_cast<std::uint64_t>(with_carry < carry) | (words_[i] < with_carry);
    }
    return *this;
  }

  [[nodiscard]] ExactAccumulator operator-() const {
    ExactAccumulator result;
    std::uint64_t carry = 1;
    for (int i = 0; i < 3; ++i) {
      result.words_[i] = ~words_[i] + carry;
      carry &= result.words_[i] == 0;
    }
    return result;
  }

  /// The double near it: off by less than 2^-51 of it.
  [[nodiscard]] double value() const {
    if (words_[2] >> 63 != 0) return -(-*this).value();
    return std::ldexp(static_cast<double>(words_[2]), 128 - kFraction) +
           (std::ldexp(static_cast<double>(words_[1]), 64 - kFraction) +
            std::ldexp(static_cast<double>(words_[0]), -kFraction));
  }

  friend bool operator==(const ExactAccumulator&, const ExactAccumulator&) = default;

 private:
  static constexpr int kFraction = 96;
  static constexpr double kMost = 0x1p63, kLeast = 0x1p-96;
  static constexpr std::uint64_t kHidden = std::uint64_t{1} << 52;

  std::uint64_t words_[3] = {};  // the lowest first
};

}  // namespace raygate
