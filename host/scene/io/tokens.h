// Tokens of text files: taken one by one, as numbers, and quoted in messages.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace raygate {

/// Takes the first word (up to a space or tab) off `text`, and the spaces and tabs after it.
/// An empty word: nothing was left.
[[nodiscard]] std::string_view take_token(std::string_view& text);

/// The same, but a word that begins with # ends the statement: the rest is a comment.
[[nodiscard]] std::string_view take_token_before_comment(std::string_view& text);

/// 'word' for a message: cut to 40 characters, what cannot be printed as \xHH.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// A decimal number to the nearest double, whatever the locale; too small a one is 0. nullopt: not
/// a number as a whole. "nan" and "inf" are numbers, and so is one that overflows to infinity.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

/// Reads a text token by token, across lines; spaces, tabs and ends of lines (LF, CR LF) are
/// between them.
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
