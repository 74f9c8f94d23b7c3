// What the values of options are made of, and how to complain about them.
#pragma once

#include <charconv>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
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

/// "; did you mean --size?" if `text` is likely to be a misspelling of one of `words`; else
/// nothing.
[[nodiscard]] std::string did_you_mean(const std::string& text, std::span<const std::string> words);

/// Throws InputError: "--size: expected WIDTHxHEIGHT, got 'big'", and `hint`.
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& expected, const std::string& hint = "");

/// Throws InputError: "--tone: expected clip or filmic, got 'flimic'; did you mean filmic?"
[[noreturn]] void fail_choice(const std::string& option, const std::string& text,
                              std::span<const std::string> choices);

/// What the choice named `text` stands for, or fail_choice.
template <typename T>
[[nodiscard]] T choose(const std::string& option, const std::string& text,
                       std::initializer_list<std::pair<const char*, T>> choices) {
  std::vector<std::string> names;
  for (const auto& [name, meaning] : choices) {
    if (text == name) return meaning;
    names.emplace_back(name);
  }
  fail_choice(option, text, names);
}

}  // namespace raygate
