// Option table: the options of a program, each declared once with its name, type, range, default
// and help, and with the places besides the command line where its value appears.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/options/option_text.h"

namespace raygate {

/// Where an option appears, besides the command line.
enum OptionPlaces : unsigned {
  kNowhere = 0,
  kInExr = 1,     ///< as an attribute: --point-error as "pointError"
  kInStats = 2,   ///< in the JSON of --stats, under the option's name
  kInPython = 4,  ///< as a keyword of the Python module
};

/// The values that a number may have. `expected` says so in messages; null: "a number from 0 to 1".
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

/// The rows of a program's options. Values go where the row says, which must outlive the table. In
/// help texts "{}" stands for the default: the value that is there when the row is added.
class OptionTable {
 public:
  using Read = std::function<void(const std::string& option, const std::string& text)>;
  using Show = std::function<std::string()>;

  /// `about` and `footer` go around the options in --help. Messages call an option --NAME; in a
  /// table for Python, of which `about` is null, NAME.
  explicit OptionTable(const char* about = nullptr, const char* footer = "");
  ~OptionTable();
  OptionTable(const OptionTable&) = delete;
  OptionTable& operator=(const OptionTable&) = delete;

  /// The heading in --help of the rows that follow.
  void group(const char* title) { group_ = title; }

  /// `names`: "-o,--output"; `value`: what it takes, as --help calls it. `read` takes the text that
  /// was typed, the last of several, or each where `repeats`. It throws InputError.
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

  /// A file or the like, as it was typed.
  template <typename Target>
  void text(const std::string& names, const char* value, const char* help, Target& target) {
    add(names, value, help, [&target](const auto&, const std::string& text) { target = text; });
  }

  void flag(const std::string& names, const char* help, bool& on);
  /// A word without an option's name: a file. They are taken in their order.
  void positional(std::string& target);
  void positionals(std::vector<std::string>& targets);

  /// Reads a command line without the program's name, and gives the text that --help or --version
  /// asks for; then nothing else is of use. Throws InputError, one line: an unknown option and what
  /// it may have been meant to be, an option without its value, a word too many, of which
  /// `too_many` says what it is.
  [[nodiscard]] std::string parse(const std::vector<std::string>& words,
                                  const std::string& too_many);

  /// Sets an option from Python, as "--name=text" does. Throws InputError.
  void set(const std::string& name, const std::string& text) const;

  /// What was typed for an option, named without dashes; empty: nothing.
  [[nodiscard]] std::string typed(const std::string& name) const;

  /// Names, as that place has them, and values of the options there that have one.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> values(OptionPlaces place) const;

 private:
  struct Row;
  struct CommandLine;

  template <typename Target>
  [[nodiscard]] static std::string text_of(const Target& target) {
    if constexpr (std::is_arithmetic_v<Target>) {
      return number_text(target);
    } else {
      return target ? number_text(*target) : "";
    }
  }

  std::unique_ptr<CommandLine> line_;
  std::vector<Row> rows_;
  const char* group_ = "";
};

}  // namespace raygate
