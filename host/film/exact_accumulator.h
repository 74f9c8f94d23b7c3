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
    // kMost's shift is 107, so that the last 64 bits have what lies above the first 128.
    const Wide low = Wide{significand} << shift;
    const std::uint64_t high = shift > 64 ? significand >> (128 - shift) : 0;
    if (number < 0.0) {
      subtract(low, high);
    } else {
      add(low, high);
    }
  }

  ExactAccumulator& operator+=(const ExactAccumulator& other) {
    add(other.low(), other.words_[2]);
    return *this;
  }

  [[nodiscard]] ExactAccumulator operator-() const {
    ExactAccumulator result;
    result.subtract(low(), words_[2]);
    return result;
  }

  /// The double near it: off by less than 2^-51 of it.
  [[nodiscard]] double value() const {
    if (words_[2] >> 63 != 0) return -(-*this).value();
    return static_cast<double>(words_[2]) * 0x1p32 +
           (static_cast<double>(words_[1]) * 0x1p-32 + static_cast<double>(words_[0]) * 0x1p-96);
  }

  friend bool operator==(const ExactAccumulator&, const ExactAccumulator&) = default;

 private:
  __extension__ using Wide = unsigned __int128;

  [[nodiscard]] Wide low() const { return Wide{words_[1]} << 64 | words_[0]; }
  void set(Wide low, std::uint64_t high) {
    words_[0] = static_cast<std::uint64_t>(low);
    words_[1] = static_cast<std::uint64_t>(low >> 64);
    words_[2] = high;
  }
  void add(Wide low, std::uint64_t high) {
    const Wide sum = this->low() + low;
    set(sum, words_[2] + high + (sum < low ? 1 : 0));
  }
  void subtract(Wide low, std::uint64_t high) {
    const Wide from = this->low();
    set(from - low, words_[2] - high - (from < low ? 1 : 0));
  }

  static constexpr int kFraction = 96;
  static constexpr double kMost = 0x1p63, kLeast = 0x1p-96;
  static constexpr std::uint64_t kHidden = std::uint64_t{1} << 52;

  std::uint64_t words_[3] = {};  // the lowest first
};

}  // namespace raygate
