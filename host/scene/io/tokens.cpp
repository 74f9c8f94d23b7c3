#include "host/scene/io/tokens.h"

#include <locale.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::string_view kBetween = " \t\r\n\v\f";

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

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : word.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F) {
      result += c;
    } else {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02X", byte);
      result += hex;
    }
  }
  return result + (word.size() > kLongest ? "...'" : "'");
}

std::optional<double> to_number(std::string_view word) {
  if (word.starts_with('+')) {
    word.remove_prefix(1);
    if (word.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument || rest != end) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not tell overflow from underflow; strtod does.
    static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
    value = strtod_l(std::string(word).c_str(), nullptr, c_locale);
  }
  return value;
}

TokenReader::TokenReader(std::string name, std::string_view text, std::size_t line)
    : name_(std::move(name)), text_(text), line_(line) {
  find_word(0);
}

/// Sets the next word to the first one at or after `from`.
void TokenReader::find_word(std::size_t from) {
  std::size_t at = from;
  for (; at < text_.size() && kBetween.find(text_[at]) != std::string_view::npos; ++at) {
    if (text_[at] == '\n') ++line_;
  }
  const std::size_t end = std::min(text_.find_first_of(kBetween, at), text_.size());
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

}  // namespace raygate
