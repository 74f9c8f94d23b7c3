// What the values of options are made of, and how to complain about them.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

/// All of `text` as a number of type T ("12", "-1.5e3"); nothing if it is not one or out of T's
/// range. Floating-point numbers may come out infinite or NaN only where the text says so.
template <typename T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// "0,0,10,20" as four numbers; nothing if any of them is not one.
template <typename T>
[[nodiscard]] std::optional<std::vector<T>> parse_list(std::string_view text) {
  std::vector<T> values;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::optional<T> value = parse_number<T>(text.substr(0, comma));
    if (!value) return std::nullopt;
    values.push_back(*value);
    if (comma == std::string_view::npos) return values;
    text.remove_prefix(comma + 1);
  }
}

/// "a,b" as two words, which may be empty; at least one.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

/// Throws InputError: "--size: expected WIDTHxHEIGHT, got 'big'".
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& expected);

}  // namespace raygate
