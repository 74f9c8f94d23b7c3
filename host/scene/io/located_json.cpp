#include "host/scene/io/located_json.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "host/base/input_error.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

/// Characters for the parser, counted in lines as it takes them.
class LineCounter {
 public:
  using difference_type = std::ptrdiff_t;
  using value_type = char;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;

  /// `line` becomes the line of the character taken last.
  LineCounter(const char* at, std::size_t* line) : at_(at), line_(line) {}

  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    // A line feed counts from the next character on: the parser reads one past a number's end.
    if (was_line_feed_) ++*line_;
    was_line_feed_ = *at_++ == '\n';
    return *this;
  }
  LineCounter operator++(int) {
    const LineCounter before = *this;
    ++*this;
    return before;
  }
  bool operator==(const LineCounter& other) const { return at_ == other.at_; }
  bool operator!=(const LineCounter& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::size_t* line_;
  bool was_line_feed_ = false;
};

std::string read_text(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (error) throw InputError(file.string() + ": cannot read: " + error.message());
  if (std::filesystem::is_directory(status)) {
    throw InputError(file.string() + ": cannot read: it is a folder");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.good()) throw InputError(file.string() + ": cannot read: Permission denied");
  if (text.empty()) throw InputError(file.string() + ": the file is empty");
  return text;
}

}  // namespace

/// What the parser calls for each value: builds the tree.
class JsonTree {
 public:
  JsonTree(std::string file, const std::size_t& line) : file_(std::move(file)), line_(line) {}

  bool null() { return add(JsonValue::Kind::kNull), true; }
  bool boolean(bool value) { return add(JsonValue::Kind::kBool).number_ = value, true; }
  bool number_integer(std::int64_t value) {
    return add_number(static_cast<double>(value), std::to_string(value));
  }
  bool number_unsigned(std::uint64_t value) {
    return add_number(static_cast<double>(value), std::to_string(value));
  }
  bool number_float(double value, const std::string& text) { return add_number(value, text); }
  bool string(std::string& value) { return add(JsonValue::Kind::kString).text_ = value, true; }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t) { return open(JsonValue::Kind::kArray); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    std::vector<std::string>& keys = open_.back()->keys_;
    if (std::ranges::find(keys, name) != keys.end()) {
      throw InputError(file_, line_, "key " + in_quotes(name) + " is there twice");
    }
    keys.push_back(name);
    return true;
  }
  bool parse_error(std::size_t, const std::string& last_token,
                   const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while
    // parsing value - invalid literal; last read: 'x'; expected ..."
    std::string what = error.what();
    const std::size_t detail = what.find(": ");
    what = detail == std::string::npos ? what : what.substr(detail + 2);
    const std::size_t read = what.find("; last read");
    if (read != std::string::npos) what = what.substr(0, read);
    throw InputError(file_, line_, "not JSON: " + what + " near " + in_quotes(last_token));
  }

  JsonValue root;

 private:
  JsonValue& add(JsonValue::Kind kind) {
    JsonValue& value = open_.empty() ? root : open_.back()->elements_.emplace_back();
    value.kind_ = kind;
    value.line_ = line_;
    return value;
  }
  bool add_number(double number, const std::string& text) {
    JsonValue& value = add(JsonValue::Kind::kNumber);
    value.number_ = number;
    value.text_ = text;
    return true;
  }
  bool open(JsonValue::Kind kind) {
    if (open_.size() == 64) throw InputError(file_, line_, "more than 64 levels, expected fewer");
    open_.push_back(&add(kind));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string file_;
  const std::size_t& line_;
  std::vector<JsonValue*> open_;  // from the root down to where values are added
};

JsonValue JsonValue::read(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::size_t line = 1;
  JsonTree tree(file.string(), line);
  nlohmann::json::sax_parse(LineCounter(text.data(), &line),
                            LineCounter(text.data() + text.size(), &line), &tree);
  return std::move(tree.root);
}

std::string JsonValue::shown() const {
  switch (kind_) {
    case Kind::kNull:
      return "null";
    case Kind::kBool:
      return boolean() ? "true" : "false";
    case Kind::kNumber:
      return text_;
    case Kind::kString:
      return in_quotes(text_);
    case Kind::kArray:
      return "an array of " + std::to_string(elements_.size());
    case Kind::kObject:
      break;
  }
  return "an object";
}

}  // namespace raygate
