// Of a ray's sure hits the one to keep, as the core's table does.
#pragma once

#include <bit>
#include <cstdint>

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// The nearest of a ray's sure hits, whose distances are off by fewer than 2^t_error numbers.
///
/// Kept is the hit whose upper bound is the smallest; what is surely not farther than that, and
/// not kept, is given to the host. The limit stands for the upper bound of the hit before the
/// first.
struct NearestSureHit {
  std::uint32_t t_max_word;  ///< of a float: no exact t at or beyond it matters any more
  bool found = false;
  std::uint32_t triangle = CoreRay::kNoTriangle;
  std::uint32_t t_word = 0;
  std::uint32_t t_error = 0;

  explicit NearestSureHit(float limit) : t_max_word(std::bit_cast<std::uint32_t>(limit)) {}

  [[nodiscard]] float limit() const { return std::bit_cast<float>(t_max_word); }

  /// Takes a hit; the triangle that must go to the host for that, or kNoTriangle.
  std::uint32_t take(std::uint32_t number, float t, std::uint32_t error) {
    constexpr std::uint32_t kInfinity = 0x7F800000;
    const std::uint32_t word = std::bit_cast<std::uint32_t>(t), margin = 1u << error;
    const std::uint32_t low = word > margin ? word - margin : 0;
    const std::uint32_t high = word + margin < kInfinity ? word + margin : kInfinity;
    if (high >= t_max_word) return low <= t_max_word ? number : CoreRay::kNoTriangle;
    const std::uint32_t old_margin = 1u << t_error;
    const std::uint32_t old_low = t_word > old_margin ? t_word - old_margin : 0;
    const std::uint32_t open = found && old_low <= high ? triangle : CoreRay::kNoTriangle;
    t_max_word = high;
    found = true;
    triangle = number;
    t_word = word;
    t_error = error;
    return open;
  }
};

}  // namespace raygate
