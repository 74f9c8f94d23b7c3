#include "host/scene/io/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <istream>
#include <limits>
#include <streambuf>
#include <unordered_set>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

/// A text for the parser, which counts the lines that were read.
class LineBuffer : public std::streambuf {
 public:
  explicit LineBuffer(std::string_view text) : counted_(text.data()) {
    char* const first = const_cast<char*>(text.data());  // which nobody writes
    setg(first, first, first + text.size());
  }
  /// Returns the line of the last character that was read. The parser reads one beyond a number.
  std::size_t line() {
    for (; counted_ + 1 < gptr(); ++counted_) line_ += *counted_ == '\n' ? 1 : 0;
    return line_;
  }

 private:
  const char* counted_;
  std::size_t line_ = 1;
};

std::string member_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}
std::string element_path(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

/// Returns a value for a message: "[1, 2]", "'text'", "an object".
std::string shown(const Json& value) {
  if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  return value.is_object() ? "an object" : value.dump();
}

Json parse(LineBuffer& text, const std::string& file, const Json::parser_callback_t& follow) {
  try {
    std::istream stream(&text);
    return Json::parse(stream, follow);
  } catch (const Json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while
    // parsing value - invalid literal; last read: 'x'; expected ..."
    std::string what = error.what();
    for (const char* const end : {"] ", "parse error at ", ": "}) {
      if (const std::size_t at = what.find(end); at <= 40) what.erase(0, at + std::strlen(end));
    }
    what = what.substr(0, std::min<std::size_t>(what.find("; expected"), 120));
    throw InputError(file, text.line(), "not JSON: " + what);
  }
}

}  // namespace

Json parse_json(std::string_view text, const std::string& file) {
  LineBuffer buffer(text);
  return parse(buffer, file, nullptr);
}

const Json& member(const Json& object, const char* key) {
  static const Json kMissing;
  if (!object.is_object()) return kMissing;
  const auto found = object.find(key);
  return found == object.end() ? kMissing : *found;
}

double number_in(const Json& object, const char* key, double otherwise) {
  const Json& value = member(object, key);
  return value.is_number() ? value.get<double>() : otherwise;
}

/// Returns an integer; -1 for another value or one beyond the range of int.
static int index_of(const Json& value) {
  const double index = value.is_number_integer() ? value.get<double>() : -1.0;
  return std::abs(index) <= std::numeric_limits<int>::max() ? static_cast<int>(index) : -1;
}

int index_in(const Json& object, const char* key) { return index_of(member(object, key)); }

std::string text_in(const Json& object, const char* key) {
  const Json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::vector<double> numbers_in(const Json& object, const char* key) {
  std::vector<double> numbers;
  const Json& list = member(object, key);
  if (!list.is_array()) return numbers;
  for (const Json& number : list) {
    if (!number.is_number()) return {};
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<int> indices_in(const Json& object, const char* key) {
  std::vector<int> indices;
  const Json& list = member(object, key);
  if (!list.is_array()) return indices;
  for (const Json& index : list) indices.push_back(index_of(index));
  return indices;
}

JsonFile::JsonFile(const std::filesystem::path& file) : file_(file.string()) {
  constexpr std::size_t kLevels = 3;  // of lines_
  struct Level {
    bool is_array;
    std::string path;
    std::size_t count = 0;                      // of the array's elements so far
    std::string key = {};                       // the object's last one
    std::unordered_set<std::string> keys = {};  // all of them
  };
  std::vector<Level> levels;
  const std::string bytes = read_file(file);
  LineBuffer text(bytes);
  const auto follow = [&](int, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_end || event == Event::array_end) {
      levels.pop_back();
      return true;
    }
    if (event == Event::key) {
      levels.back().key = parsed.get<std::string>();
      if (!levels.back().keys.insert(levels.back().key).second) {
        throw InputError(file_, text.line(),
                         "key " + in_quotes(levels.back().key) + " is there twice");
      }
      return true;
    }
    std::string path;
    if (!levels.empty() && levels.size() <= kLevels) {
      Level& level = levels.back();
      path = level.is_array ? element_path(level.path, level.count++)
                            : member_path(level.path, level.key);
    }
    lines_.emplace(path, text.line());
    if (event != Event::value) levels.push_back({event == Event::array_start, path});
    return true;
  };
  root_ = parse(text, file_, follow);
}

std::size_t JsonFile::line_of(std::string path) const {
  for (auto found = lines_.find(path);; found = lines_.find(path)) {
    if (found != lines_.end()) return found->second;
    const std::size_t end = path.find_last_of(".[");
    path.resize(end == std::string::npos ? 0 : end);
  }
}

void JsonValue::fail(const std::string& expected) const {
  throw InputError(file_->name(), line(),
                   name() + ": " + shown(*value_) + ", expected " + expected);
}

void JsonValue::require_keys(std::initializer_list<const char*> known) const {
  std::string names;
  for (const char* key : known) names.append(names.empty() ? "" : ", ").append(key);
  if (!value_->is_object()) fail("an object with " + names);
  for (const auto& [key, value] : value_->items()) {
    if (std::ranges::find(known, key) != known.end()) continue;
    throw InputError(file_->name(), JsonValue(value, *file_, member_path(path_, key)).line(),
                     name() + ": unknown key " + in_quotes(key) + ", expected some of " + names);
  }
}

std::size_t JsonValue::line() const { return file_->line_of(path_); }

std::map<std::string, JsonValue> JsonValue::members() const {
  if (!value_->is_object()) fail("an object");
  std::map<std::string, JsonValue> all;
  for (const auto& [key, value] : value_->items()) {
    all.emplace(key, JsonValue(value, *file_, member_path(path_, key)));
  }
  return all;
}

std::optional<JsonValue> JsonValue::find(const std::string& key) const {
  if (!value_->contains(key)) return std::nullopt;
  return JsonValue((*value_)[key], *file_, member_path(path_, key));
}

JsonValue JsonValue::at(const std::string& key) const {
  const auto found = find(key);
  if (!found) throw InputError(file_->name(), line(), name() + ": '" + key + "' is missing");
  return *found;
}

std::vector<JsonValue> JsonValue::elements() const {
  if (!value_->is_array()) fail("an array");
  std::vector<JsonValue> all;
  all.reserve(value_->size());
  for (const Json& element : *value_) {
    all.push_back({element, *file_, element_path(path_, all.size())});
  }
  return all;
}

std::vector<JsonValue> JsonValue::elements(const std::string& key) const {
  const auto found = find(key);
  return found ? found->elements() : std::vector<JsonValue>();
}

double JsonValue::number() const {
  constexpr double kLargest = std::numeric_limits<float>::max();
  const double number = value_->is_number() ? value_->get<double>() : 2.0 * kLargest;
  if (!(std::abs(number) <= kLargest)) fail("a number within the range of float");
  return number;
}

std::optional<double> JsonValue::number_in(const std::string& key, double low, double high,
                                           const std::string& expected) const {
  const auto value = find(key);
  if (!value) return std::nullopt;
  const double found = value->number();
  if (!(found >= low && found <= high)) value->fail(expected);
  return found;
}

std::string JsonValue::string(const std::string& expected) const {
  if (!value_->is_string() || value_->get_ref<const std::string&>().empty()) fail(expected);
  return *value_;
}

std::string JsonValue::word(const std::string& expected) const {
  if (!value_->is_string() && !value_->is_number()) fail(expected);
  return value_->is_string() ? value_->get<std::string>() : value_->dump();
}

glm::dvec3 JsonValue::vector() const {
  if (!value_->is_array() || value_->size() != 3) fail("[x, y, z]");
  const std::vector<JsonValue> xyz = elements();
  return {xyz[0].number(), xyz[1].number(), xyz[2].number()};
}

glm::dvec3 JsonValue::direction() const {
  const glm::dvec3 xyz = vector();
  if (xyz == glm::dvec3(0.0)) fail("a direction: not all three 0");
  return unit(xyz);
}

glm::vec3 JsonValue::light() const {
  const bool is_grey = value_->is_number();
  if (!is_grey && (!value_->is_array() || value_->size() != 3)) {
    fail("[red, green, blue] or one number for all three");
  }
  const glm::dvec3 rgb = is_grey ? glm::dvec3(number()) : vector();
  if (glm::min(rgb.x, glm::min(rgb.y, rgb.z)) < 0.0) fail("no negative number");
  return glm::vec3(rgb);
}

}  // namespace raygate
