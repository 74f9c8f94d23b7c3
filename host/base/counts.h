// Saturating counts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace raygate {

/// Adds `more`; saturates at the largest number instead of wrapping around.
inline void add_count(std::uint32_t& count, std::uint32_t more) {
  count += std::min(more, std::numeric_limits<std::uint32_t>::max() - count);
}

}  // namespace raygate
