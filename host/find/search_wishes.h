// What searches are asked for, ray by ray.
#pragma once

#include <cstdint>
#include <span>

namespace raygate {

/// As the members of Search say; spans may be empty.
struct SearchWishes {
  std::span<const float> limits{};
  std::span<const std::uint32_t> ignored{};
  std::span<const float> enough_before{};
};

}  // namespace raygate
