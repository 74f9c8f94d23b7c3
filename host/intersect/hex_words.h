// Floats as hexadecimal words, for messages from which a case can be replayed.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

namespace raygate {

/// " 3F800000 BF000000".
[[nodiscard]] inline std::string hex_words(std::span<const float> words) {
  std::string text;
  for (const float word : words) {
    char buffer[16];
    std::snprintf(buffer, sizeof buffer, " %08X", std::bit_cast<std::uint32_t>(word));
    text += buffer;
  }
  return text;
}

}  // namespace raygate
