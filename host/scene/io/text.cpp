#include "host/scene/io/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

/// Returns whether a character separates tokens: a space or one of \t \n \v \f \r.
bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool has_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (at == 0 || is_blank(line[at - 1])) return true;
  }
  return false;
}

}  // namespace

std::string_view take_token(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] != ' ' && text[end] != '\t') ++end;
  const std::string_view word = text.substr(0, end);
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
  text.remove_prefix(end);
  return word;
}

std::string_view take_token_before_comment(std::string_view& text) {
  if (!text.empty() && text[0] == '#') text = {};
  return take_token(text);
}

TokenReader::TokenReader(std::string name, std::string_view text, std::size_t line)
    : name_(std::move(name)), text_(text), line_(line) {
  find_word(0);
}

/// Sets the next word to the first one at or after `from`.
void TokenReader::find_word(std::size_t from) {
  std::size_t at = from;
  for (; at < text_.size() && is_space(text_[at]); ++at) {
    if (text_[at] == '\n') ++line_;
  }
  std::size_t end = at;
  while (end < text_.size() && !is_space(text_[end])) ++end;
  word_ = text_.substr(at, end - at);
}

std::string_view TokenReader::take() {
  if (at_end()) fail("the file ends too soon");
  const std::string_view word = word_;
  last_ = static_cast<std::size_t>(word.data() - text_.data()) + word.size();
  last_line_ = line_;
  find_word(last_);
  return word;
}

void TokenReader::expect(std::string_view word) {
  if (at_end()) fail("the file ends too soon, expected " + in_quotes(word));
  if (peek() != word) fail("found " + in_quotes(peek()) + ", expected " + in_quotes(word));
  (void)take();
}

double TokenReader::number(std::string_view of_what) {
  const auto number = to_number(peek());
  if (!number || !(std::abs(*number) <= std::numeric_limits<float>::max())) {
    fail(std::string(of_what) + ": found " + (at_end() ? "the file's end" : in_quotes(peek())) +
         ", expected a finite number");
  }
  (void)take();
  return *number;
}

long long TokenReader::whole(std::string_view of_what, long long low, long long high) {
  const std::string_view word = peek();
  long long number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || number < low || number > high) {
    fail(std::string(of_what) + ": found " + (at_end() ? "the file's end" : in_quotes(word)) +
         ", expected a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  (void)take();
  return number;
}

void TokenReader::skip_line() {
  const std::size_t end = std::min(text_.find('\n', last_), text_.size());
  line_ = last_line_;
  find_word(end);
}

void TokenReader::fail(const std::string& what) const { throw InputError(name_, line_, what); }

TextLines::TextLines(const std::filesystem::path& file)
    : name_(file.string()),
      bytes_(std::make_shared<const std::string>(read_file(file))),
      text_(*bytes_) {
  if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) {
    throw InputError(name_, 1, "UTF-16 text, expected ASCII or UTF-8");
  }
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;
  if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
    while (position_ <= nul) take_line();
    throw InputError(name_, lines_taken_, "a byte of value 0: not a text file");
  }
}

// Takes one line without its end. There must be one.
std::string_view TextLines::take_line() {
  // Each LF is searched once, so that a file whose lines end in CR alone takes linear time.
  if (newline_ == kNotLooked || newline_ < position_) {
    newline_ = std::min(text_.find('\n', position_), text_.size());
  }
  const std::string_view to_newline(text_.data() + position_, newline_ - position_);
  const std::size_t length = std::min(to_newline.find('\r'), to_newline.size());
  position_ += length + 1;
  if (position_ == newline_ && length < to_newline.size()) ++position_;  // CR LF
  position_ = std::min(position_, text_.size());
  ++lines_taken_;
  return to_newline.substr(0, length);
}

std::optional<std::string_view> TextLines::next() {
  while (position_ < text_.size()) {
    std::string_view line = take_line();
    statement_line_ = lines_taken_;
    std::string_view statement = trimmed(line);
    if (statement.empty() || statement[0] == '#') continue;
    if (line.back() == '\\' && !has_comment(line)) {
      joined_.clear();
      while (!line.empty() && line.back() == '\\' && !has_comment(line)) {
        joined_ += line.substr(0, line.size() - 1);
        joined_ += ' ';
        line = position_ < text_.size() ? take_line() : std::string_view();
      }
      joined_ += line;
      statement = trimmed(joined_);
      if (statement.empty()) continue;
    }
    return statement;
  }
  return std::nullopt;
}

// Parts start after an LF without a preceding backslash, which might join two lines.
std::vector<TextLines> TextLines::split(std::size_t most, std::size_t size) const {
  std::vector<TextLines> parts;
  const std::size_t step = std::max(size, (text_.size() - position_) / most + 1);
  std::size_t begin = position_;
  while (begin < text_.size()) {
    std::size_t end = begin + std::min(step, text_.size() - begin) - 1;
    const auto joins = [&] {
      const std::size_t before = end > begin && text_[end - 1] == '\r' ? end - 1 : end;
      return before > begin && text_[before - 1] == '\\';
    };
    do {
      end = std::min(text_.find('\n', end), text_.size() - 1);
    } while (joins() && ++end < text_.size());
    end = std::min(end + 1, text_.size());
    parts.push_back(TextLines(*this, begin, end));
    begin = end;
  }
  return parts;
}

std::string TextLines::place() const { return InputError::location(name_, statement_line_); }

double TextLines::number(std::string_view word, std::string_view of_what) const {
  const std::optional<double> number = to_number(word);
  if (!number) fail(std::string(of_what) + ": " + in_quotes(word) + ", expected a number");
  if (!(std::abs(*number) <= std::numeric_limits<float>::max())) {
    fail(std::string(of_what) + ": " + in_quotes(word) +
         ", expected a finite number within the range of float");
  }
  return *number;
}

void TextLines::fail(const std::string& what) const {
  throw InputError(name_, statement_line_, what);
}

}  // namespace raygate
