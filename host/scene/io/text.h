// Text files: statements of lines, and tokens.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/text.h"

namespace raygate {

/// Removes the first word (up to a space or tab) from `text`, with the spaces and tabs after it,
/// and returns it. Returns an empty word if `text` is empty.
[[nodiscard]] std::string_view take_token(std::string_view& text);

/// Takes a token, but treats a word that begins with # and all text after it as a comment.
[[nodiscard]] std::string_view take_token_before_comment(std::string_view& text);

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

/// A text file as a sequence of OBJ or MTL statements:
/// * a line ends with LF, CR or CR LF; a UTF-8 byte order mark is skipped;
/// * a backslash at the end of a line joins the next line to it, with a space between;
/// * a line whose first character is # is a comment. A line with a # that begins a word is never
///   continued: the comment may end in a backslash by chance, as in "# C:\models\".
class TextLines {
 public:
  /// Throws InputError if the file cannot be read, is a folder, is empty, or is not 8-bit text.
  explicit TextLines(const std::filesystem::path& file);

  /// Returns the next statement that is not empty, without spaces and tabs at its ends, or nullopt
  /// at the end of the file. The result is valid until the next call.
  [[nodiscard]] std::optional<std::string_view> next();

  /// Splits the unread part, at statement boundaries, into at most `most` parts of at least about
  /// `size` bytes. Each part counts its lines from 1.
  [[nodiscard]] std::vector<TextLines> split(std::size_t most, std::size_t size) const;
  /// Counts lines from lines + 1. To be called before the first next().
  void begin_after(std::size_t lines) { lines_taken_ = lines; }
  [[nodiscard]] std::size_t lines_taken() const { return lines_taken_; }

  /// Returns whether the file contains `text` anywhere, comments included.
  [[nodiscard]] bool has(std::string_view text) const { return text_.find(text) != text_.npos; }

  /// Sets line(), and thus the line in messages, to that of an earlier statement.
  void go_to(std::size_t line) { statement_line_ = line; }
  /// Returns the line, from 1, on which the last statement begins.
  [[nodiscard]] std::size_t line() const { return statement_line_; }
  [[nodiscard]] const std::string& file_name() const { return name_; }

  /// Returns "file:line: " for the last statement.
  [[nodiscard]] std::string place() const;

  /// Throws InputError that names the file and the line of the last statement.
  [[noreturn]] void fail(const std::string& what) const;
  /// Returns the word as a finite number within the range of float. Otherwise fails with a message
  /// that names `of_what`, such as "Kd".
  [[nodiscard]] double number(std::string_view word, std::string_view of_what) const;

 private:
  static constexpr std::size_t kNotLooked = std::string_view::npos;

  std::string_view take_line();

  TextLines(const TextLines& whole, std::size_t begin, std::size_t end)
      : name_(whole.name_), bytes_(whole.bytes_), text_(whole.text_.substr(begin, end - begin)) {}

  std::string name_;
  std::shared_ptr<const std::string> bytes_;  // of the file
  std::string_view text_;                     // all of them, or a part
  std::string joined_;                        // a statement of several lines
  std::size_t position_ = 0;
  std::size_t newline_ = kNotLooked;  // the first LF at or after position_, or the end
  std::size_t lines_taken_ = 0;
  std::size_t statement_line_ = 0;
};

/// Base of the readers of OBJ and MTL files: their statements, and warnings about them.
class StatementReader {
 public:
  /// `warnings` must outlive this object.
  StatementReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : lines_(file), warnings_(warnings) {}

 protected:
  [[nodiscard]] const TextLines& lines() const { return lines_; }
  [[nodiscard]] TextLines& lines() { return lines_; }

  [[nodiscard]] std::vector<std::string>& warnings() { return warnings_; }
  void warn(const std::string& what) { warnings_.push_back(lines_.place() + what); }

  /// Warns at the first call for this keyword and does nothing at later ones.
  void warn_once(std::string_view keyword, const std::string& what) {
    if (warned_of_.emplace(keyword).second) warn(what);
  }

 private:
  TextLines lines_;
  std::vector<std::string>& warnings_;
  std::set<std::string, std::less<>> warned_of_;
};

}  // namespace raygate
