// JsonFile: JSON values with their lines and paths, and access that checks their types.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <istream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "host/base/input.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"

namespace raygate {

using Json = nlohmann::json;

/// Stream buffer of a text, which counts the lines that the parser has read.
class LineBuffer : public std::streambuf {
 public:
  explicit LineBuffer(std::string_view text) : counted_(text.data()) {
    char* const first = const_cast<char*>(text.data());  // never written
    setg(first, first, first + text.size());
  }
  /// Returns the line of the last character read. For a number, that is the character after it.
  std::size_t line() {
    for (; counted_ + 1 < gptr(); ++counted_) line_ += *counted_ == '\n' ? 1 : 0;
    return line_;
  }

 private:
  const char* counted_;
  std::size_t line_ = 1;
};

/// Parses JSON (RFC 8259). Throws InputError, "file:line: not JSON: ...".
inline Json parse_json(LineBuffer& text, const std::string& file,
                       const Json::parser_callback_t& follow = nullptr) {
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

class JsonFile {
 public:
  /// Parses `file`. Throws InputError, "file:line: what", if it cannot be read or is not JSON, or
  /// if an object has a key twice.
  explicit JsonFile(const std::filesystem::path& file) : name(file.string()) {
    constexpr std::size_t kLevels = 3;  // maximum depth of paths in lines_
    struct Level {
      bool is_array;
      std::string path;
      std::size_t count = 0;                      // elements of the array so far
      std::string key = {};                       // last key of the object
      std::unordered_set<std::string> keys = {};  // all keys of the object
    };
    std::vector<Level> levels;
    const std::string bytes = read_file(file);
    LineBuffer text(bytes);
    root = parse_json(text, name, [&](int, Json::parse_event_t event, const Json& parsed) {
      using Event = Json::parse_event_t;
      if (event == Event::object_end || event == Event::array_end) {
        levels.pop_back();
        return true;
      }
      if (event == Event::key) {
        levels.back().key = parsed.get<std::string>();
        if (!levels.back().keys.insert(levels.back().key).second) {
          throw InputError(name, text.line(),
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
    });
  }

  /// Returns the line of a value: where an array or object starts, or where any other value ends.
  /// For values more than three levels deep, returns the line of an enclosing value.
  [[nodiscard]] std::size_t line_of(std::string path) const {
    for (auto found = lines_.find(path);; found = lines_.find(path)) {
      if (found != lines_.end()) return found->second;
      const std::size_t end = path.find_last_of(".[");
      path.resize(end == std::string::npos ? 0 : end);
    }
  }

  static std::string member_path(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
  }
  static std::string element_path(const std::string& path, std::size_t index) {
    return path + "[" + std::to_string(index) + "]";
  }

  std::string name;
  Json root;

 private:
  std::map<std::string, std::size_t> lines_;  // by path
};

/// A value of a JsonFile, which must outlive this object. Functions throw InputError for a value of
/// another type: "a.json:7: camera.eye[1]: 'up', expected a number within the range of float".
class JsonValue {
 public:
  explicit JsonValue(const JsonFile& file) : JsonValue(file.root, file, "") {}

  [[noreturn]] void fail(const std::string& expected) const {
    std::string found = "an object";
    if (value_->is_primitive()) found = value_->dump();
    if (value_->is_string()) found = in_quotes(value_->get_ref<const Text&>());
    if (value_->is_array()) found = "an array of " + std::to_string(value_->size());
    throw InputError(file_->name, line(), label() + found + ", expected " + expected);
  }
  [[nodiscard]] std::size_t line() const { return file_->line_of(path_); }

  /// Requires an object with no keys other than `known`.
  void require_keys(std::initializer_list<const char*> known) const {
    std::string names;
    for (const char* key : known) names.append(names.empty() ? "" : ", ").append(key);
    if (!value_->is_object()) fail("an object with " + names);
    for (const auto& [key, value] : members()) {
      if (std::ranges::find(known, key) != known.end()) continue;
      throw InputError(file_->name, value.line(),
                       label() + "unknown key " + in_quotes(key) + ", expected some of " + names);
    }
  }
  /// Returns the keys of an object and their values, sorted by key.
  [[nodiscard]] std::vector<std::pair<std::string, JsonValue>> members() const {
    if (!value_->is_object()) fail("an object");
    std::vector<std::pair<std::string, JsonValue>> all;
    for (const auto& [key, value] : value_->items()) all.emplace_back(key, member(key));
    return all;
  }
  /// Returns the value of a key of an object, or nullopt if the key is missing.
  [[nodiscard]] std::optional<JsonValue> find(const std::string& key) const {
    return value_->contains(key) ? std::optional(member(key)) : std::nullopt;
  }
  [[nodiscard]] JsonValue at(const std::string& key) const {
    const auto found = find(key);
    if (!found) throw InputError(file_->name, line(), label() + "'" + key + "' is missing");
    return *found;
  }

  [[nodiscard]] std::vector<JsonValue> elements() const {
    if (!value_->is_array()) fail("an array");
    std::vector<JsonValue> all;
    for (const Json& element : *value_) {
      all.push_back({element, *file_, JsonFile::element_path(path_, all.size())});
    }
    return all;
  }
  /// Returns the elements of the array at a key; none if the key is missing.
  [[nodiscard]] std::vector<JsonValue> elements(const std::string& key) const {
    const auto found = find(key);
    return found ? found->elements() : std::vector<JsonValue>();
  }

  /// Returns a number within the range of float.
  [[nodiscard]] double number() const {
    constexpr double kLargest = std::numeric_limits<float>::max();
    const double number = value_->is_number() ? value_->get<double>() : 2.0 * kLargest;
    if (!(std::abs(number) <= kLargest)) fail("a number within the range of float");
    return number;
  }
  /// Returns the number at a key, which must be in [low, high], or nullopt if the key is missing.
  /// `expected` describes the range in messages.
  [[nodiscard]] std::optional<double> number_in(const std::string& key, double low, double high,
                                                const std::string& expected) const {
    const auto value = find(key);
    if (!value) return std::nullopt;
    const double found = value->number();
    if (!(found >= low && found <= high)) value->fail(expected);
    return found;
  }
  /// Returns a string that is not empty; `expected` describes it in messages.
  [[nodiscard]] std::string string(const std::string& expected) const {
    if (!value_->is_string() || value_->get_ref<const Text&>().empty()) fail(expected);
    return *value_;
  }
  /// Returns a string, or a number as text.
  [[nodiscard]] std::string word(const std::string& expected) const {
    if (!value_->is_string() && !value_->is_number()) fail(expected);
    return value_->is_string() ? value_->get<std::string>() : value_->dump();
  }
  /// Returns the vector of an array [x, y, z].
  [[nodiscard]] glm::dvec3 vector() const {
    if (!value_->is_array() || value_->size() != 3) fail("[x, y, z]");
    const std::vector<JsonValue> xyz = elements();
    return {xyz[0].number(), xyz[1].number(), xyz[2].number()};
  }
  /// Returns the unit vector in the direction of an array [x, y, z] that is not zero.
  [[nodiscard]] glm::dvec3 direction() const {
    const glm::dvec3 xyz = vector();
    if (xyz == glm::dvec3(0.0)) fail("a direction: not all three 0");
    return unit(xyz);
  }
  /// Returns a colour: an array [red, green, blue], or one number for all three. None is negative.
  [[nodiscard]] glm::vec3 light() const {
    const bool is_grey = value_->is_number();
    if (!is_grey && (!value_->is_array() || value_->size() != 3)) {
      fail("[red, green, blue] or one number for all three");
    }
    const glm::dvec3 rgb = is_grey ? glm::dvec3(number()) : vector();
    if (glm::min(rgb.x, glm::min(rgb.y, rgb.z)) < 0.0) fail("no negative number");
    return glm::vec3(rgb);
  }

 private:
  using Text = std::string;

  JsonValue(const Json& value, const JsonFile& file, std::string path)
      : value_(&value), file_(&file), path_(std::move(path)) {}

  [[nodiscard]] JsonValue member(const std::string& key) const {
    return {(*value_)[key], *file_, JsonFile::member_path(path_, key)};
  }
  [[nodiscard]] std::string label() const { return (path_.empty() ? "scene" : path_) + ": "; }

  const Json* value_;
  const JsonFile* file_;
  std::string path_;  // from the root, as in "lights[2].edges"
};

}  // namespace raygate
