// Tokens of text files, as words, as numbers and in messages.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace raygate {

/// Removes the first word (up to a space or tab) from `text`, with the spaces and tabs after it,
/// and returns it. Returns an empty word if `text` is empty.
[[nodiscard]] std::string_view take_token(std::string_view& text);

/// Takes a token, but treats a word that begins with # and all text after it as a comment.
[[nodiscard]] std::string_view take_token_before_comment(std::string_view& text);

/// Returns the word in quotes for a message: its first 40 characters, with unprintable ones as
/// \xHH.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Returns a decimal number as the nearest double, in any locale, or nullopt if the whole word is
/// not a number. "nan" and "inf" are numbers; a magnitude too large gives infinity, too small 0.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

/// Reads a text token by token. Spaces, tabs and ends of lines (LF, CR LF) separate tokens.
class TokenReader {
 public:
  /// The file's name and the number of the text's first line are for messages.
  TokenReader(std::string name, std::string_view text, std::size_t line = 1);

  /// Returns the next word without taking it; an empty word at the end.
  [[nodiscard]] std::string_view peek() const { return word_; }
  [[nodiscard]] bool at_end() const { return word_.empty(); }
  /// Takes the next word. Throws InputError at the end.
  std::string_view take();
  /// Takes the next word. Throws InputError if it is another one.
  void expect(std::string_view word);
  /// Takes a finite number within the range of float.
  [[nodiscard]] double number(std::string_view of_what);
  /// Takes a whole number from `low` to `high`.
  [[nodiscard]] long long whole(std::string_view of_what, long long low, long long high);
  /// Skips the rest of the line of the last word that was taken.
  void skip_line();

  /// Returns the line of the next word, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Throws InputError with the line of the next word.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void find_word(std::size_t from);

  std::string name_;
  std::string_view text_;
  std::string_view word_;      // the next word
  std::size_t last_ = 0;       // end of the word before it
  std::size_t last_line_ = 0;  // line of the word before it
  std::size_t line_;
};

}  // namespace raygate
