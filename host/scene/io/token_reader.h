// Words of a text, one at a time, with the lines on which they stand.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace raygate {

/// Words have spaces, tabs and ends of lines between them (LF, CR LF).
class TokenReader {
 public:
  /// `name` of the file and `line` of the text's first one are for messages.
  TokenReader(std::string name, std::string_view text, std::size_t line = 1);

  /// The next word, which stays; empty at the end.
  [[nodiscard]] std::string_view peek() const { return word_; }
  [[nodiscard]] bool at_end() const { return word_.empty(); }
  /// The next word; throws InputError at the end.
  std::string_view take();
  /// Takes a word that must be this one.
  void expect(std::string_view word);
  /// Takes a finite number within the range of float.
  [[nodiscard]] double number(std::string_view of_what);
  /// Takes a whole number from `low` to `high`.
  [[nodiscard]] long long whole(std::string_view of_what, long long low, long long high);
  /// Takes what is left of the line of the word taken last.
  void skip_line();

  /// Of the next word, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Throws InputError at the next word.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void find_word(std::size_t from);

  std::string name_;
  std::string_view text_;
  std::string_view word_;      // the next one
  std::size_t last_ = 0;       // where the word before it ends
  std::size_t last_line_ = 0;  // and its line
  std::size_t line_;
};

}  // namespace raygate
