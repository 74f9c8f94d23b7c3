#include "host/scene/io/tokens.h"

#include <locale.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace raygate {

std::string_view take_token(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != ' ' && text[end] != '\t') ++end;
  const std::string_view word = text.substr(0, end);
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
  text.remove_prefix(end);
  return word;
}

std::string_view take_token_before_comment(std::string_view& text) {
  if (!text.empty() && text[0] == '#') text = {};
  return take_token(text);
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : word.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) {
      result += c;
    } else {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02X", byte);
      result += hex;
    }
  }
  return result + (word.size() > kLongest ? "...'" : "'");
}

std::optional<double> to_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument || rest != end) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not say whether it is too large or too small; strtod does.
    static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
    value = strtod_l(std::string(word).c_str(), nullptr, c_locale);
  }
  return value;
}

double expect_number(const TextLines& lines, std::string_view word, std::string_view of_what) {
  const std::optional<double> number = to_number(word);
  if (!number) lines.fail(std::string(of_what) + ": " + in_quotes(word) + ", expected a number");
  if (!std::isfinite(*number) || std::abs(*number) > std::numeric_limits<float>::max()) {
    lines.fail(std::string(of_what) + ": " + in_quotes(word) +
               ", expected a finite number within the range of float");
  }
  return *number;
}

}  // namespace raygate
