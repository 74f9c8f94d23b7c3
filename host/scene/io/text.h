// Text files: words, and the statements of OBJ and MTL files.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "host/base/input.h"
#include "host/base/input_error.h"

namespace raygate {

/// Returns whether a character separates words: a space or one of \t \n \v \f \r.
inline bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

inline char in_lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Returns the place of the first # that begins a word, or npos.
inline std::size_t find_comment(std::string_view line) {
  std::size_t at = line.find('#');
  while (at != line.npos && at > 0 && !is_space(line[at - 1])) at = line.find('#', at + 1);
  return at;
}

inline std::string in_lower_case(std::string text) {
  for (char& letter : text) letter = in_lower_case(letter);
  return text;
}

/// Reads a text word by word. White space separates words.
class Words {
 public:
  /// `file` and the characters of `text` must outlive this object. `line` is the number of the
  /// text's first line, or 0 if messages should not name a line.
  Words(const std::string& file, std::string_view text, std::size_t line = 0)
      : file_(&file), text_(text), line_(line) {
    find_word(0);
  }

  [[nodiscard]] bool at_end() const { return word_.empty(); }
  /// Returns the next word without taking it; an empty word at the end.
  [[nodiscard]] std::string_view peek() const { return word_; }
  /// Takes the next word and returns it; an empty word at the end.
  std::string_view take() {
    const std::string_view word = word_;
    find_word(next_);
    return word;
  }
  /// If the next word equals `word` (lower case) in any letter case, takes it and returns true.
  bool take_if(std::string_view word) {
    const auto is_same = [](char small, char letter) { return small == in_lower_case(letter); };
    const bool is_equal = word == word_ || std::ranges::equal(word, word_, is_same);
    if (is_equal) (void)take();
    return is_equal;
  }
  /// Takes the next word. Throws InputError unless it equals `word`, as for take_if().
  void expect(std::string_view word) {
    if (take_if(word)) return;
    fail((at_end() ? "the file ends too soon" : "found " + in_quotes(word_)) + ", expected " +
         in_quotes(word));
  }
  /// Takes a number within the range of float. Otherwise throws InputError, which names `what`.
  double number(std::string_view what) {
    const auto number = to_number(word_);
    if (!number || !(std::abs(*number) <= std::numeric_limits<float>::max())) {
      fail(std::string(what) + ": found " + (at_end() ? "the end" : in_quotes(word_)) +
           ", expected a number within the range of float");
    }
    (void)take();
    return *number;
  }
  /// Takes any word. Returns its number, or NaN if the word is not a number.
  double any_number() {
    return to_number(take()).value_or(std::numeric_limits<double>::quiet_NaN());
  }

  /// Returns the text that begins at the next word.
  [[nodiscard]] std::string_view rest() const { return text_.substr(next_ - word_.size()); }
  /// Drops the next word that begins with '#', and the text after it.
  void drop_comment() {
    const std::size_t begin = next_ - word_.size(), length = find_comment(text_.substr(begin));
    if (length == text_.npos) return;
    text_ = text_.substr(0, begin + length);
    find_word(begin);
  }

  [[nodiscard]] std::size_t line() const { return line_; }
  /// Returns "file:line: " for the next word.
  [[nodiscard]] std::string place() const { return InputError::location(*file_, line_); }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(*file_, line_, what); }

 private:
  /// Sets the next word to the first one at or after `from`.
  void find_word(std::size_t from) {
    std::size_t at = from;
    for (; at < text_.size() && is_space(text_[at]); ++at) {
      if (text_[at] == '\n' && line_ > 0) ++line_;
    }
    next_ = at;
    while (next_ < text_.size() && !is_space(text_[next_])) ++next_;
    word_ = text_.substr(at, next_ - at);
  }

  const std::string* file_;
  std::string_view text_;
  std::string_view word_;  // the next word
  std::size_t next_ = 0;   // end of word_
  std::size_t line_ = 0;   // line of word_
};

/// A text file as a sequence of OBJ or MTL statements:
/// * a line ends with LF, CR or CR LF; a UTF-8 byte order mark is skipped;
/// * a backslash at the end of a line joins the next line to it, with a space between;
/// * a line whose first character is # is a comment. A line with a # that begins a word is never
///   continued: the comment may end in a backslash by chance, as in "# C:\models\".
class TextLines {
 public:
  /// Throws InputError if the file cannot be read, is a folder, is empty, or is not 8-bit text.
  explicit TextLines(const std::filesystem::path& file)
      : name_(file.string()), bytes_(read_file(file)) {
    if (bytes_.starts_with("\xFF\xFE") || bytes_.starts_with("\xFE\xFF")) {
      throw InputError(name_, 1, "UTF-16 text, expected ASCII or UTF-8");
    }
    if (bytes_.find('\r') != bytes_.npos) {  // CR LF and CR become LF
      std::size_t size = 0;
      for (std::size_t i = 0; i < bytes_.size(); ++i) {
        if (bytes_[i] == '\r' && bytes_.compare(i + 1, 1, "\n") == 0) continue;
        bytes_[size++] = bytes_[i] == '\r' ? '\n' : bytes_[i];
      }
      bytes_.resize(size);
    }
    if (const std::size_t nul = bytes_.find('\0'); nul != bytes_.npos) {
      const auto line =
          std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
      throw InputError(name_, static_cast<std::size_t>(line) + 1,
                       "a byte of value 0: not a text file");
    }
    text_ = bytes_;
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Returns the words of the next statement that is not empty, or nullopt at the end of the file.
  /// The result is valid until the next call.
  [[nodiscard]] std::optional<Words> next() {
    while (!text_.empty()) {
      std::string_view line = take_line();
      const std::size_t first_line = lines_taken_;
      if (is_continued(line)) {
        joined_.clear();
        for (; is_continued(line); line = text_.empty() ? std::string_view() : take_line()) {
          joined_.append(line.substr(0, line.size() - 1)).append(" ");
        }
        line = joined_.append(line);
      }
      while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
      const Words words(name_, line, first_line);
      if (!words.at_end() && !words.peek().starts_with('#')) return words;
    }
    return std::nullopt;
  }

 private:
  static bool is_continued(std::string_view line) {
    return line.ends_with('\\') && find_comment(line) == line.npos;
  }

  /// Takes the next line, which must exist, without its end.
  std::string_view take_line() {
    const std::size_t length = std::min(text_.find('\n'), text_.size());
    const std::string_view line = text_.substr(0, length);
    text_.remove_prefix(std::min(length + 1, text_.size()));
    ++lines_taken_;
    return line;
  }

  std::string name_, bytes_;
  std::string_view text_;  // the unread part
  std::string joined_;     // a statement of several lines
  std::size_t lines_taken_ = 0;
};

}  // namespace raygate
