// Tests every predicate on all kinds of floats: subnormals, zeros of both signs, NaN, infinities.
#include "host/exact/test/bit_patterns.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

namespace raygate {
namespace {

/// Returns random words. Many are equal to an earlier word, adjacent to it, or have its exponent.
test::Patterns patterns(std::mt19937_64& random) {
  test::Patterns words{};
  const auto below = [&](std::size_t n) { return random() % n; };
  const auto exponent = static_cast<std::uint32_t>(below(256));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto any = static_cast<std::uint32_t>(random());
    switch (below(8)) {
      case 0:
        words[i] = any;
        break;
      case 1:
        words[i] = any & 0x807FFFFF;  // zero or subnormal
        break;
      case 2: {
        constexpr std::uint32_t kSpecial[] = {0x00000000, 0x80000000, 0x00000001, 0x007FFFFF,
                                              0x00800000, 0x7F7FFFFF, 0x7F800000, 0x7FC00000,
                                              0xFF800000, 0x3F800000, 0xBF800000};
        words[i] = kSpecial[below(std::size(kSpecial))];
        break;
      }
      case 3:
      case 4:  // an earlier word, or the float next to it
        words[i] = words[below(i + 1)] + static_cast<std::uint32_t>(below(2));
        break;
      case 5:
        words[i] = (any & 0x80700000) | exponent << 23;
        break;
      default:
        words[i] = (any & 0x807FFFFF) | ((exponent + below(4)) & 0xFF) << 23;
        break;
    }
  }
  return words;
}

TEST(BitPatterns, EveryPredicateAgreesWithRationals) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 8000; ++i) {
    const test::Patterns words = patterns(random);
    const std::string wrong = test::disagreement(words);
    if (wrong.empty()) continue;
    std::string text;
    for (const std::uint32_t word : words) {
      char hex[16];
      std::snprintf(hex, sizeof hex, "%08X ", word);
      text += hex;
    }
    FAIL() << wrong << ": " << text;
  }
}

}  // namespace
}  // namespace raygate
