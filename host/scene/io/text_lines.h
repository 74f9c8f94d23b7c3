// TextLines: the statements of a text file, with their line numbers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace raygate {

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
