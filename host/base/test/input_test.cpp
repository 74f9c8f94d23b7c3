// Parses numbers, and quotes words.
#include "host/base/input.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace raygate {
namespace {

TEST(Quotes, ShowWhatCannotBePrinted) {
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_EQ(in_quotes("a\x01\x7f"), "'a\\x01\\x7F'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Numbers, AreReadToTheNearestDouble) {
  EXPECT_EQ(to_number("1"), 1.0);
  EXPECT_EQ(to_number("+1.5"), 1.5);
  EXPECT_EQ(to_number("-.5e1"), -5.0);
  EXPECT_EQ(to_number("7."), 7.0);
  EXPECT_EQ(to_number("0.1"), 0.1);
  EXPECT_EQ(to_number("123456.78901234567"), 123456.78901234567);
  EXPECT_EQ(to_number("9007199254740993"), 9007199254740992.0);              // tie rounds to even
  EXPECT_EQ(to_number("2.2250738585072011e-308"), 2.2250738585072011e-308);  // subnormal
}

TEST(Numbers, TooSmallIsZeroTooLargeIsInfinite) {
  EXPECT_EQ(to_number("1e-400"), 0.0);
  EXPECT_TRUE(std::signbit(*to_number("-1e-99999999999")));
  EXPECT_EQ(to_number("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(to_number("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_number("1" + std::string(400, '0')), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(*to_number("nan")));
  EXPECT_TRUE(std::isinf(*to_number("-inf")));
}

TEST(Numbers, AreWholeWords) {
  for (const char* word : {"", "+", "-", "+-1", "--1", "1e", "1e+", "1,5", "0x10", "1f", "1 ", "a",
                           ".", "1_000", "1.2.3", "1d3"}) {
    EXPECT_EQ(to_number(word), std::nullopt) << word;
  }
}

TEST(Numbers, DoNotDependOnTheLocale) {
  // All of these locales have a decimal comma; one of them may be installed.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"}) {
    if (std::setlocale(LC_ALL, name)) break;
  }
  EXPECT_EQ(to_number("1.5"), 1.5);
  EXPECT_EQ(to_number("1.5e-400"), 0.0);
  EXPECT_EQ(to_number("1.5e400"), std::numeric_limits<double>::infinity());
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace raygate
