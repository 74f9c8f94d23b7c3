#include "host/scene/io/json_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>

#include "host/base/file_bytes.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

using Kind = JsonNode::Kind;

/// Passes characters to the parser and counts lines.
class LineCounter {
 public:
  using difference_type = std::ptrdiff_t;
  using value_type = char;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;

  /// Keeps `line` at the line of the last character that was passed.
  LineCounter(const char* at, std::size_t* line) : at_(at), line_(line) {}

  reference operator*() const { return *at_; }
  LineCounter& operator++() {
    // A line feed counts at the next character, as the parser reads one beyond a number's end.
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

/// Handler of the parser's events, which builds the tree of values.
class TreeBuilder {
 public:
  TreeBuilder(const std::string& file, const std::size_t& line, JsonNode& root)
      : file_(file), line_(line), root_(root) {}

  bool null() { return add(Kind::kNull), true; }
  bool boolean(bool value) { return add(Kind::kBool).number = value, true; }
  bool number_integer(std::int64_t value) {
    return number_float(static_cast<double>(value), std::to_string(value));
  }
  bool number_unsigned(std::uint64_t value) {
    return number_float(static_cast<double>(value), std::to_string(value));
  }
  bool number_float(double value, const std::string& text) {
    JsonNode& node = add(Kind::kNumber);
    node.number = value;
    node.text = text;
    return true;
  }
  bool string(std::string& value) { return add(Kind::kString).text = value, true; }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(Kind::kObject); }
  bool start_array(std::size_t) { return open(Kind::kArray); }
  bool end_object() { return open_.pop_back(), true; }
  bool end_array() { return open_.pop_back(), true; }
  bool key(std::string& name) {
    if (!seen_[open_.size()].insert(name).second) {
      throw InputError(file_, line_, "key " + in_quotes(name) + " is there twice");
    }
    open_.back()->keys.push_back(name);
    return true;
  }
  bool parse_error(std::size_t, const std::string& last_token,
                   const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while
    // parsing value - invalid literal; last read: 'x'; expected ..."
    std::string what = error.what();
    const std::size_t detail = what.find(": ");
    what = detail == std::string::npos ? what : what.substr(detail + 2);
    what = what.substr(0, what.find("; last read"));
    throw InputError(file_, line_, "not JSON: " + what + " near " + in_quotes(last_token));
  }

 private:
  JsonNode& add(Kind kind) {
    JsonNode& node = open_.empty() ? root_ : open_.back()->elements.emplace_back();
    node.kind = kind;
    node.line = line_;
    return node;
  }
  bool open(Kind kind) {
    if (open_.size() == kLevels)
      throw InputError(file_, line_, "more than 64 levels, expected fewer");
    open_.push_back(&add(kind));
    seen_[open_.size()].clear();
    return true;
  }

  const std::string& file_;
  const std::size_t& line_;
  JsonNode& root_;
  static constexpr std::size_t kLevels = 64;
  std::vector<JsonNode*> open_;  // from the root down to the node to which values are added
  std::array<std::unordered_set<std::string>, kLevels + 1> seen_;  // keys of the open objects
};

/// Returns a value for a message: "[1, 2]", "'text'", "an object".
std::string shown(const JsonNode& node) {
  switch (node.kind) {
    case Kind::kNull:
      return "null";
    case Kind::kBool:
      return node.number != 0.0 ? "true" : "false";
    case Kind::kNumber:
      return node.text;
    case Kind::kString:
      return in_quotes(node.text);
    case Kind::kArray:
      return "an array of " + std::to_string(node.elements.size());
    case Kind::kObject:
      break;
  }
  return "an object";
}

}  // namespace

JsonFile::JsonFile(const std::filesystem::path& file) : file_(file.string()) {
  const std::string text = read_file(file);
  std::size_t line = 1;
  TreeBuilder builder(file_, line, root_);
  nlohmann::json::sax_parse(LineCounter(text.data(), &line),
                            LineCounter(text.data() + text.size(), &line), &builder);
}

void JsonValue::fail(const std::string& expected) const {
  throw InputError(*file_, line(), name() + ": " + shown(*node_) + ", expected " + expected);
}

void JsonValue::require_keys(std::span<const char* const> known) const {
  std::string names;
  for (const char* key : known) names.append(names.empty() ? "" : ", ").append(key);
  if (node_->kind != Kind::kObject) fail("an object with " + names);
  for (std::size_t i = 0; i < keys().size(); ++i) {
    if (std::ranges::find(known, keys()[i]) != known.end()) continue;
    throw InputError(
        *file_, node_->elements[i].line,
        name() + ": unknown key " + in_quotes(keys()[i]) + ", expected some of " + names);
  }
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
  const auto found = std::ranges::find(keys(), key);
  if (found == keys().end()) return std::nullopt;
  return JsonValue(node_->elements[static_cast<std::size_t>(found - keys().begin())], *file_,
                   path_.empty() ? key : path_ + "." + key);
}

JsonValue JsonValue::at(const std::string& key) const {
  const auto found = find(key);
  if (!found) throw InputError(*file_, line(), name() + ": '" + key + "' is missing");
  return *found;
}

std::vector<JsonValue> JsonValue::elements() const {
  if (node_->kind != Kind::kArray) fail("an array");
  std::vector<JsonValue> all;
  all.reserve(node_->elements.size());
  for (const JsonNode& element : node_->elements) {
    all.push_back({element, *file_, path_ + "[" + std::to_string(all.size()) + "]"});
  }
  return all;
}

std::vector<JsonValue> JsonValue::elements(const std::string& key) const {
  const auto found = find(key);
  return found ? found->elements() : std::vector<JsonValue>();
}

double JsonValue::number() const {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (node_->kind != Kind::kNumber || !(std::abs(node_->number) <= kLargest)) {
    fail("a number within the range of float");
  }
  return node_->number;
}

double JsonValue::number_in(const std::string& key, double low, double high,
                            const std::string& expected, double missing) const {
  const auto value = find(key);
  if (!value) return missing;
  const double found = value->number();
  if (!(found >= low && found <= high)) value->fail(expected);
  return found;
}

const std::string& JsonValue::string(const std::string& expected) const {
  if (node_->kind != Kind::kString || node_->text.empty()) fail(expected);
  return node_->text;
}

const std::string& JsonValue::word(const std::string& expected) const {
  if (node_->kind != Kind::kString && node_->kind != Kind::kNumber) fail(expected);
  return node_->text;
}

glm::dvec3 JsonValue::vector() const {
  if (node_->kind != Kind::kArray || node_->elements.size() != 3) fail("[x, y, z]");
  const std::vector<JsonValue> xyz = elements();
  return {xyz[0].number(), xyz[1].number(), xyz[2].number()};
}

glm::dvec3 JsonValue::direction() const {
  const glm::dvec3 xyz = vector();
  if (xyz == glm::dvec3(0.0)) fail("a direction: not all three 0");
  return unit(xyz);
}

glm::vec3 JsonValue::light() const {
  const bool is_grey = node_->kind == Kind::kNumber;
  if (!is_grey && (node_->kind != Kind::kArray || node_->elements.size() != 3)) {
    fail("[red, green, blue] or one number for all three");
  }
  const glm::dvec3 rgb = is_grey ? glm::dvec3(number()) : vector();
  if (glm::min(rgb.x, glm::min(rgb.y, rgb.z)) < 0.0) fail("no negative number");
  return glm::vec3(rgb);
}

}  // namespace raygate
