// Text files: words, and the statements of OBJ and MTL files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/input.h"

namespace raygate {

/// Returns the text with the letters A to Z in lower case.
[[nodiscard]] std::string in_lower_case(std::string text);

/// Reads a text word by word. White space separates words.
class Words {
 public:
  /// `file` and the characters of `text` must outlive this object. `line` is the number of the
  /// text's first line, or 0 if messages shall not name a line.
  Words(const std::string& file, std::string_view text, std::size_t line = 0)
      : file_(&file), text_(text), line_(line) {
    find_word(0);
  }

  [[nodiscard]] bool at_end() const { return word_.empty(); }
  /// Returns the next word without taking it; an empty word at the end.
  [[nodiscard]] std::string_view peek() const { return word_; }
  /// Takes the next word and returns it; an empty word at the end.
  std::string_view take();
  /// Takes the next word if it equals `word`, which is in lower case, in any case of letters.
  bool take_if(std::string_view word);
  /// Takes the next word. Throws InputError unless it equals `word`, as for take_if().
  void expect(std::string_view word);
  /// Takes a number within the range of float. Throws InputError, which calls it `what`, else.
  double number(std::string_view what);
  /// Takes any word. Returns NaN for one that is not a number.
  double any_number();

  /// Returns the text from the next word on.
  [[nodiscard]] std::string_view rest() const { return text_.substr(next_ - word_.size()); }
  /// Drops the next word that begins with '#', and the text after it.
  void drop_comment();

  /// Returns the line of the next word.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Returns "file:line: " for the next word.
  [[nodiscard]] std::string place() const;
  /// Throws InputError with the line of the next word.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void find_word(std::size_t from);

  const std::string* file_;
  std::string_view text_;
  std::string_view word_;  // the next word
  std::size_t next_ = 0;   // its end
  std::size_t line_ = 0;   // its line
};

/// A text file as a sequence of OBJ or MTL statements:
/// * a line ends with LF, CR or CR LF; a UTF-8 byte order mark is skipped;
/// * a backslash at the end of a line joins the next line to it, with a space between;
/// * a line whose first character is # is a comment. A line with a # that begins a word is never
///   continued: the comment may end in a backslash by chance, as in "# C:\models\".
class TextLines {
 public:
  /// Throws InputError if the file cannot be read, is a folder, is empty, or is not 8-bit text.
  explicit TextLines(const std::filesystem::path& file);
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Returns the words of the next statement that is not empty, or nullopt at the end of the file.
  /// The result is valid until the next call.
  [[nodiscard]] std::optional<Words> next();

 private:
  std::string_view take_line();

  std::string name_, bytes_;
  std::string_view text_;  // the unread part
  std::string joined_;     // a statement of several lines
  std::size_t lines_taken_ = 0;
};

}  // namespace raygate
