// Option text: values from text and back, and the messages about text that is no value.
#pragma once

#include <algorithm>
#include <charconv>
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

/// The shortest text that parse_number reads as `value`.
template <typename T>
[[nodiscard]] std::string number_text(T value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// "a,b" as two words, which may be empty; at least one.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

/// "0,0,10,20" as four numbers; nothing if any of them is not one.
template <typename T>
[[nodiscard]] std::optional<std::vector<T>> parse_list(const std::string& text) {
  std::vector<T> values;
  for (const std::string& word : split_at_commas(text)) {
    const std::optional<T> value = parse_number<T>(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// "name=value" as its two halves; a missing half is empty.
[[nodiscard]] std::pair<std::string, std::string> split_at_equals(const std::string& text);

/// "a, b or c".
[[nodiscard]] std::string listed(std::span<const std::string> words, const char* last = " or ");

/// "; did you mean --size?" if `text` is likely to be a misspelling of one of `words`; else
/// nothing.
[[nodiscard]] std::string did_you_mean(const std::string& text, std::span<const std::string> words);

/// Throws InputError: "--size: expected WIDTHxHEIGHT, got 'big'", and `hint`.
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& expected, const std::string& hint = "");

/// The words that an option takes, and the value of each.
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

template <typename T>
[[nodiscard]] std::vector<std::string> names_of(const Choices<T>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  return names;
}

/// The name of `value`, which is one of the choices.
template <typename T>
[[nodiscard]] std::string name_of(const Choices<T>& choices, const T& value) {
  return std::ranges::find(choices, value, &std::pair<std::string, T>::second)->first;
}

/// The value named `text`. Throws InputError: "--tone: expected clip or filmic, got 'flimic'; did
/// you mean filmic?"
template <typename T>
[[nodiscard]] T choose(const std::string& option, const std::string& text,
                       const Choices<T>& choices) {
  for (const auto& [name, value] : choices) {
    if (text == name) return value;
  }
  const std::vector<std::string> names = names_of(choices);
  fail_value(option, text, listed(names), did_you_mean(text, names));
}

/// The words of "a,b", each of which must be one of `names`.
[[nodiscard]] std::vector<std::string> choose_some(const std::string& option,
                                                   const std::string& text,
                                                   std::span<const std::string> names);

}  // namespace raygate
