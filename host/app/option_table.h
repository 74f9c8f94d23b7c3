// Option table: the options of a program. Each is declared once, with its names, range, default,
// help text, and the places besides the command line where it appears.
#pragma once

#include <algorithm>
#include <charconv>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/scene/io/scene_loader.h"

namespace raygate {

/// Parses all of `text` as a number of type T ("12", "-1.5e3"). Returns nullopt if the text is not
/// a number or is out of T's range. Only the texts "inf" and "nan" give infinity and NaN.
template <typename T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// Returns the shortest text that parse_number reads as `value`.
template <typename T>
[[nodiscard]] std::string number_text(T value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Splits "a,b" into words, which may be empty; returns at least one.
[[nodiscard]] std::vector<std::string> split_at(char separator, const std::string& text);

/// Parses "0,0,10,20"; returns an empty list if a word is not a number.
template <typename T>
[[nodiscard]] std::vector<T> parse_list(const std::string& text, char separator = ',') {
  std::vector<T> values;
  for (const std::string& word : split_at(separator, text)) {
    const std::optional<T> value = parse_number<T>(word);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

/// Returns the text that parse_list reads as `values`.
[[nodiscard]] std::string list_text(std::initializer_list<double> values);

/// Splits "name=value"; a missing half is empty.
[[nodiscard]] std::pair<std::string, std::string> split_at_equals(const std::string& text);

/// Returns "a, b or c".
[[nodiscard]] std::string listed(std::span<const std::string> words, const char* last = " or ");

/// The words that an option accepts and their values.
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Returns the name of `value`, which must be one of the choices.
template <typename T>
[[nodiscard]] std::string name_of(const Choices<T>& choices, const T& value) {
  return std::ranges::find(choices, value, &std::pair<std::string, T>::second)->first;
}

template <typename T>
[[nodiscard]] std::optional<T> value_of(const Choices<T>& choices, const std::string& name) {
  const auto found = std::ranges::find(choices, name, &std::pair<std::string, T>::first);
  return found == choices.end() ? std::nullopt : std::optional<T>(found->second);
}

template <typename T>
[[nodiscard]] std::vector<std::string> names_of(const Choices<T>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  return names;
}

/// The closed range of a number. `expected`: text for messages; null: "a number from LOW to HIGH".
template <typename T>
struct Range {
  T low, high;
  const char* expected = nullptr;

  [[nodiscard]] bool contains(T value) const { return value >= low && value <= high; }
  [[nodiscard]] std::string text() const {
    if (expected != nullptr) return expected;
    return std::string(std::is_integral_v<T> ? "a whole number" : "a number") + " from " +
           number_text(low) + " to " + number_text(high);
  }
};

/// Places where an option appears, besides the command line.
enum OptionPlaces : unsigned {
  kNowhere = 0,
  kInExr = 1,        ///< EXR attribute: --point-error as "pointError"
  kInStats = 2,      ///< key in the JSON of --stats, under the option's name
  kInPython = 4,     ///< keyword of the Python module
  kInSceneFile = 8,  ///< key of "render" in scene files
  kInPage = 16,      ///< parameter of requests to --serve
  kMostUsed = 32,    ///< listed first in --help, not in its group
};

/// The words of a command line.
struct CommandLine {
  std::vector<OptionValue> values;
  std::vector<std::string> plain;  ///< words that belong to no option
};

/// The options of a program, in the order of --help. Values are stored in the rows' targets, which
/// must outlive the table. "{}" in a help text is the target's value at the time of adding.
class OptionTable {
 public:
  /// Stores a value; returns false if the text does not match the row's `expected`.
  using Read = std::function<bool(const std::string& text)>;
  /// Returns the current value as text, "" for none.
  using Show = std::function<std::string()>;

  /// `about` and `footer` enclose the options in --help. `dashes` precede names in messages.
  explicit OptionTable(std::string about = "", std::string footer = "", const char* dashes = "--")
      : about_(std::move(about)), footer_(std::move(footer)), dashes_(dashes) {}
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  /// Sets the heading in --help of the rows that are added next.
  void group(const char* title) { group_ = title; }

  /// Adds an option. `names`: "-o,--output"; the first long name is the option's name. `value`:
  /// placeholder of its value in --help; null for a flag. `expected` describes values in messages.
  void add(const std::string& names, const char* value, const std::string& help,
           const std::string& expected, const Read& read, const Show& show = {},
           unsigned places = kNowhere);

  /// Adds an option. `parse` returns the value of a text, or nullopt if the text is not valid.
  /// `target`: a T or an optional T. `show` returns the text of a value.
  template <typename T, typename Target>
  void value(const std::string& names, const char* value, const std::string& help,
             const std::string& expected, Target& target,
             const std::function<std::optional<T>(const std::string&)>& parse,
             const std::function<std::string(const T&)>& show = {}, unsigned places = kNowhere) {
    add(
        names, value, help, expected,
        [&target, parse](const std::string& text) {
          const std::optional<T> parsed = parse(text);
          if (!parsed) return false;
          const T& found = *parsed;
          target = found;
          return true;
        },
        [&target, show] {
          const std::optional<T> current = target;
          return current ? show(*current) : "";
        },
        places);
  }

  template <typename T, typename Target>
  void number(const std::string& names, const char* placeholder, const char* help, Target& target,
              const Range<T>& range, unsigned places = kNowhere) {
    value<T>(
        names, placeholder, help, range.text(), target,
        [range](const std::string& text) {
          const std::optional<T> number = parse_number<T>(text);
          return number && range.contains(*number) ? number : std::nullopt;
        },
        number_text<T>, places);
  }

  template <typename T, typename Target>
  void choice(const std::string& names, const char* placeholder, const char* help, Target& target,
              const Choices<T>& choices, unsigned places = kNowhere) {
    value<T>(
        names, placeholder, help, listed(names_of(choices)), target,
        [choices](const std::string& text) { return value_of(choices, text); },
        [choices](const T& value) { return name_of(choices, value); }, places);
  }

  /// Adds an option whose value is stored as typed, such as a file name.
  template <typename Target>
  void text(const std::string& names, const char* value, const char* help, Target& target) {
    add(names, value, help, "a value", [&target](const auto& text) { return target = text, true; });
  }

  void flag(const std::string& names, const char* help, bool& on) {
    add(names, nullptr, help, "", [&on](const auto&) { return on = true; });
  }

  /// Splits a command line without the program's name: "--name VALUE", "--name=VALUE", "-n VALUE",
  /// flags, and other words; all words after "--" are plain. A VALUE that is the name of an option
  /// needs "=". Throws InputError for an unknown option or a missing value, and Information for
  /// --help and --version.
  [[nodiscard]] CommandLine split(const std::vector<std::string>& words);

  /// Reads values of known options in the order of the rows. If an option has several values, the
  /// last one counts. Throws InputError "--size: found 'big', expected WIDTHxHEIGHT".
  void read(const std::vector<OptionValue>& values);

  /// Splits a command line and reads its values.
  [[nodiscard]] CommandLine parse(const std::vector<std::string>& words);

  /// Returns the last value read for an option, which is named without dashes; "" if there is none.
  [[nodiscard]] std::string given(const std::string& name) const;

  /// Throws InputError "--size: found 'big', expected WIDTHxHEIGHT" for the option's last value.
  [[noreturn]] void fail_value(const std::string& name, const std::string& expected) const;
  /// Throws InputError: `message`, and the place in a scene file that sets any of `names`.
  [[noreturn]] void fail(const std::string& message,
                         std::initializer_list<const char*> names) const;

  /// Throws InputError "unknown option 'colour', ..." unless the option appears at `place`.
  void require(const OptionValue& value, OptionPlaces place) const;

  /// Returns name/value pairs of the options shown at `place`. Omits options without a value.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> values(OptionPlaces place) const;

 private:
  struct Row {
    std::vector<std::string> names;  // with dashes, as in --help
    std::string name;                // first long name, without dashes
    const char* value;               // null: a flag
    std::string help;
    const char* group;
    std::string expected;
    Read read;
    Show show;
    unsigned places;
    std::optional<OptionValue> given;  // last value read
  };

  [[nodiscard]] std::string help() const;
  [[nodiscard]] const Row& row(const std::string& name) const;

  std::string about_, footer_, dashes_;
  std::vector<Row> rows_;
  const char* group_ = "";
};

}  // namespace raygate
