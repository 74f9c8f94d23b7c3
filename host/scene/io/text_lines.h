// The statements of a text file, one at a time, with the line on which each begins.
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

  /// Cuts what has not been read into parts, at most so many and of about `size` bytes at least,
  /// that have the same statements one after the other. Their lines are counted from 1 again.
  [[nodiscard]] std::vector<TextLines> split(std::size_t most, std::size_t size) const;
  /// Lines are counted on from there; before the first next().
  void begin_after(std::size_t lines) { lines_taken_ = lines; }
  [[nodiscard]] std::size_t lines_taken() const { return lines_taken_; }

  /// Whether the file has `text` anywhere, comments included.
  [[nodiscard]] bool has(std::string_view text) const { return text_.find(text) != text_.npos; }

  /// Makes line() and all that names it that of a statement given earlier.
  void go_to(std::size_t line) { statement_line_ = line; }
  /// The line (from 1) on which the statement begins that next() gave last.
  [[nodiscard]] std::size_t line() const { return statement_line_; }
  [[nodiscard]] const std::string& file_name() const { return name_; }

  /// "file:line: " of the last statement.
  [[nodiscard]] std::string place() const;

  /// Throws InputError that names the file and the line of the last statement.
  [[noreturn]] void fail(const std::string& what) const;
  /// The word as a finite number within the range of float; else fails and says what it is the
  /// number of ("Kd").
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

/// What readers of OBJ and MTL files share: their statements, and warnings about them.
class StatementReader {
 public:
  /// `warnings` must outlive this.
  StatementReader(const std::filesystem::path& file, std::vector<std::string>& warnings)
      : lines_(file), warnings_(warnings) {}

 protected:
  /// Where the reading is.
  [[nodiscard]] const TextLines& lines() const { return lines_; }
  [[nodiscard]] TextLines& lines() { return lines_; }

  [[nodiscard]] std::vector<std::string>& warnings() { return warnings_; }
  void warn(const std::string& what) { warnings_.push_back(lines_.place() + what); }

  /// Warns of the first statement with this keyword alone.
  void warn_once(std::string_view keyword, const std::string& what) {
    if (warned_of_.emplace(keyword).second) warn(what);
  }

 private:
  TextLines lines_;
  std::vector<std::string>& warnings_;
  std::set<std::string, std::less<>> warned_of_;
};

}  // namespace raygate
