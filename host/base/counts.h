// Counts that stay at the largest number instead of beginning again at 0.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace raygate {

/// Adds `more`, up to the largest number.
inline void add_count(std::uint32_t& count, std::uint32_t more) {
  count += std::min(more, std::numeric_limits<std::uint32_t>::max() - count);
}

}  // namespace raygate
