// The statements of a text file, one at a time, with the line on which each begins.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace raygate {

/// A file read as a whole and handed out as statements of the OBJ and MTL kind:
/// * a line ends with LF, CR or CR LF; a UTF-8 byte order mark is skipped;
/// * a backslash at the end of a line joins the next line to it, with a space between;
/// * a line whose first character is # is a comment. A line with a # that begins a word is never
///   continued: the comment may end in a backslash by chance, as in "# C:\models\".
class TextLines {
 public:
  /// Throws InputError: what cannot be read, is a folder, is empty, or is not 8-bit text.
  explicit TextLines(const std::filesystem::path& file);

  /// The next statement, without spaces and tabs at either end; never empty. nullopt at the end of
  /// the file. Valid until the next call.
  [[nodiscard]] std::optional<std::string_view> next();

  /// The line (from 1) on which the statement begins that next() gave last.
  [[nodiscard]] std::size_t line() const { return statement_line_; }
  [[nodiscard]] const std::string& file_name() const { return name_; }

  /// "file:line: " of the last statement.
  [[nodiscard]] std::string place() const;

  /// Throws InputError that names the file and the line of the last statement.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view take_line();

  std::string name_;
  std::string text_;
  std::string joined_;  // a statement of several lines
  std::size_t position_ = 0;
  std::size_t newline_ = 0;  // the first LF at or after position_, once take_line has looked
  std::size_t lines_taken_ = 0;
  std::size_t statement_line_ = 0;
};

}  // namespace raygate
