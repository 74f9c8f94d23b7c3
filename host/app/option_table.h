// Option table: the options of a program, each declared once with its name, type, range, default,
// help text, and the places besides the command line where its value appears.
#pragma once

#include <algorithm>
#include <charconv>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace raygate {

/// Parses all of `text` as a number of type T ("12", "-1.5e3"). Returns none if it is not a number
/// or out of T's range; floating-point numbers are infinite or NaN only if the text says so.
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
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

/// Parses "0,0,10,20"; returns none if a word is not a number.
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

/// Splits "name=value"; a missing half is empty.
[[nodiscard]] std::pair<std::string, std::string> split_at_equals(const std::string& text);

/// Returns "a, b or c".
[[nodiscard]] std::string listed(std::span<const std::string> words, const char* last = " or ");

/// Returns "; did you mean --size?" if `text` is probably a misspelling of one of `words`, else "".
[[nodiscard]] std::string did_you_mean(const std::string& text, std::span<const std::string> words);

/// Throws InputError "--size: expected WIDTHxHEIGHT, got 'big'", followed by `hint`.
[[noreturn]] void fail_value(const std::string& option, const std::string& text,
                             const std::string& expected, const std::string& hint = "");

/// The words that an option accepts and their values.
template <typename T>
using Choices = std::vector<std::pair<std::string, T>>;

template <typename T>
[[nodiscard]] std::vector<std::string> names_of(const Choices<T>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) names.push_back(name);
  return names;
}

/// Returns the name of `value`, which must be one of the choices.
template <typename T>
[[nodiscard]] std::string name_of(const Choices<T>& choices, const T& value) {
  return std::ranges::find(choices, value, &std::pair<std::string, T>::second)->first;
}

/// Returns the value named `text`. Throws InputError "--tone: expected clip or filmic, got
/// 'flimic'; did you mean filmic?"
template <typename T>
[[nodiscard]] T choose(const std::string& option, const std::string& text,
                       const Choices<T>& choices) {
  for (const auto& [name, value] : choices) {
    if (text == name) return value;
  }
  const std::vector<std::string> names = names_of(choices);
  fail_value(option, text, listed(names), did_you_mean(text, names));
}

/// Splits "a,b" into words. Throws InputError if one is not in `names`.
[[nodiscard]] std::vector<std::string> choose_some(const std::string& option,
                                                   const std::string& text,
                                                   std::span<const std::string> names);

/// Where an option appears besides the command line.
enum OptionPlaces : unsigned {
  kNowhere = 0,
  kInExr = 1,        ///< EXR attribute: --point-error as "pointError"
  kInStats = 2,      ///< key in the JSON of --stats, under the option's name
  kInPython = 4,     ///< keyword of the Python module
  kInSceneFile = 8,  ///< key of "render" in scene files
  kInPage = 16,      ///< parameter of requests to --serve
};

/// The closed range of a number. `expected` describes it in messages; null: "a number from 0 to 1".
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

/// The options of a program, in the order of --help. Parsed values are stored in the targets that
/// the rows name, which must outlive the table. "{}" in a help text is replaced by the default: the
/// target's value when the row is added.
///
/// A command line has words "--name VALUE", "--name=VALUE", "-n VALUE", "-nVALUE", flags "--name"
/// and "-n", and positional words. The last of several values counts. An option's value may begin
/// with a dash; after "--" every word is positional.
class OptionTable {
 public:
  /// Takes the option's name as messages show it, and the text of its value. Throws InputError.
  using Read = std::function<void(const std::string& option, const std::string& text)>;
  using Show = std::function<std::string()>;

  /// `about` and `footer` enclose the options in --help.
  explicit OptionTable(std::string about = "", std::string footer = "")
      : about_(std::move(about)), footer_(std::move(footer)) {}
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  /// Sets the heading in --help of the rows that are added next.
  void group(const char* title) { group_ = title; }

  /// Adds an option. `names`: "-o,--output"; the first long name is the option's name. `value`:
  /// the placeholder of its value in --help. `read` is called with the last value typed, or with
  /// each if the option `repeats`. `show` returns the current value as text, "" for none.
  void add(const std::string& names, const char* value, std::string help, Read read, Show show = {},
           unsigned places = kNowhere, bool repeats = false);

  template <typename T, typename Target>
  void number(const std::string& names, const char* value, const char* help, Target& target,
              const Range<T>& range, unsigned places = kNowhere) {
    add(
        names, value, help,
        [&target, range](const std::string& option, const std::string& text) {
          const std::optional<T> number = parse_number<T>(text);
          if (!number || !range.contains(*number)) fail_value(option, text, range.text());
          const T valid = *number;
          target = valid;
        },
        [&target] { return text_of(target); }, places);
  }

  template <typename T>
  void choice(const std::string& names, const char* value, const char* help, T& target,
              const Choices<T>& choices, unsigned places = kNowhere) {
    add(
        names, value, help,
        [&target, choices](const std::string& option, const std::string& text) {
          target = choose(option, text, choices);
        },
        [&target, choices] { return name_of(choices, target); }, places);
  }

  /// Adds an option whose value is stored as typed, such as a file name.
  template <typename Target>
  void text(const std::string& names, const char* value, const char* help, Target& target) {
    add(names, value, help, [&target](const auto&, const std::string& text) { target = text; });
  }

  void flag(const std::string& names, const char* help, bool& on) {
    add(names, nullptr, help, [&on](const auto&, const auto&) { on = true; });
  }
  /// Adds a positional word, such as a file name. They are filled in order.
  void positional(std::string& target) { positionals_.push_back(&target); }
  /// Collects all positional words.
  void positionals(std::vector<std::string>& targets) { all_positionals_ = &targets; }

  /// Parses a command line without the program's name and stores the values. Returns the text that
  /// --help or --version asks for; the targets are then incomplete. Throws InputError, one line:
  /// an unknown option with the likely intended one, an option without its value, or one positional
  /// word too many, described by `too_many`.
  [[nodiscard]] std::string parse(const std::vector<std::string>& words,
                                  const std::string& too_many);

  /// Sets an option that Python shows; messages name it without dashes. Throws InputError.
  void set(const std::string& name, const std::string& text) const;

  /// Returns the last value typed for an option, named without dashes; "" if there was none.
  [[nodiscard]] std::string typed(const std::string& name) const;

  /// Throws InputError "WHERE: unknown key 'colour', expected some of ..." unless the option `name`
  /// appears at `place`.
  void require(const std::string& name, OptionPlaces place, const std::string& where) const;

  /// Name/value pairs of the options shown at `place`; options without a value are omitted.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> values(OptionPlaces place) const;

 private:
  struct Row {
    std::vector<std::string> names;  // with dashes, as in --help
    std::string name;                // the first long one, without dashes
    const char* value;               // null: a flag
    std::string help;
    const char* group;
    Read read;
    Show show;
    unsigned places;
    bool repeats;
    std::vector<std::string> typed;  // values, in order
  };

  [[nodiscard]] std::string help() const;
  [[nodiscard]] Row* find(const std::string& name);
  [[noreturn]] void fail_unknown(const std::string& word) const;

  template <typename Target>
  [[nodiscard]] static std::string text_of(const Target& target) {
    if constexpr (std::is_arithmetic_v<Target>) {
      return number_text(target);
    } else {
      return target ? number_text(*target) : "";
    }
  }

  std::string about_, footer_;
  std::vector<Row> rows_;
  const char* group_ = "";
  std::vector<std::string*> positionals_;
  std::vector<std::string>* all_positionals_ = nullptr;
};

}  // namespace raygate
