// JsonFile: JSON values with their lines and paths, and access that checks their types.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raygate {

using Json = nlohmann::json;

/// Parses JSON (RFC 8259). Throws InputError, "file:line: not JSON: ...".
[[nodiscard]] Json parse_json(std::string_view text, const std::string& file);

// Members of JSON objects. For files of other programs, which often have small errors: a member of
// a wrong type counts as missing, and so do all members of a value that is not an object.

/// Returns the member at a key; null if it is missing.
[[nodiscard]] const Json& member(const Json& object, const char* key);
[[nodiscard]] double number_in(const Json& object, const char* key, double otherwise);
/// Returns an integer; -1, which is no valid index, if it is missing or beyond the range of int.
[[nodiscard]] int index_in(const Json& object, const char* key);
[[nodiscard]] std::string text_in(const Json& object, const char* key);
/// Returns an array of numbers; an empty list unless all elements are numbers.
[[nodiscard]] std::vector<double> numbers_in(const Json& object, const char* key);
/// Returns an array of indices, with -1 for elements that are not integers.
[[nodiscard]] std::vector<int> indices_in(const Json& object, const char* key);

class JsonFile;

/// A value of a JsonFile, which must outlive this object. Functions throw InputError for a value of
/// another type: "a.json:7: camera.eye[1]: 'up', expected a number within the range of float".
class JsonValue {
 public:
  [[noreturn]] void fail(const std::string& expected) const;
  [[nodiscard]] std::size_t line() const;

  /// Requires an object without other keys than these.
  void require_keys(std::initializer_list<const char*> known) const;
  /// Returns the values of an object and their keys, sorted by key.
  [[nodiscard]] std::map<std::string, JsonValue> members() const;
  /// Returns the value of a key of an object, or nullopt if the key is missing.
  [[nodiscard]] std::optional<JsonValue> find(const std::string& key) const;
  /// Returns the value of a required key.
  [[nodiscard]] JsonValue at(const std::string& key) const;

  /// Returns the elements of an array.
  [[nodiscard]] std::vector<JsonValue> elements() const;
  /// Returns the elements of the array at a key; none if the key is missing.
  [[nodiscard]] std::vector<JsonValue> elements(const std::string& key) const;

  /// Returns a number within the range of float.
  [[nodiscard]] double number() const;
  /// Returns the number at a key, which is from `low` to `high`, or nullopt if there is no such
  /// key. `expected` describes the range in messages.
  [[nodiscard]] std::optional<double> number_in(const std::string& key, double low, double high,
                                                const std::string& expected) const;
  /// Returns a string that is not empty; `expected` describes it in messages.
  [[nodiscard]] std::string string(const std::string& expected) const;
  /// Returns a string, or a number as text.
  [[nodiscard]] std::string word(const std::string& expected) const;
  /// Returns the vector of an array [x, y, z].
  [[nodiscard]] glm::dvec3 vector() const;
  /// Returns the unit vector in the direction of an array [x, y, z] that is not zero.
  [[nodiscard]] glm::dvec3 direction() const;
  /// Returns the colour of an array [red, green, blue] or of one number, none negative.
  [[nodiscard]] glm::vec3 light() const;

 private:
  friend class JsonFile;
  JsonValue(const Json& value, const JsonFile& file, std::string path)
      : value_(&value), file_(&file), path_(std::move(path)) {}

  [[nodiscard]] std::string name() const { return path_.empty() ? "scene" : path_; }

  const Json* value_;
  const JsonFile* file_;
  std::string path_;  // from the root, as in "lights[2].edges"
};

class JsonFile {
 public:
  /// Parses `file`. Throws InputError, "file:line: what", if it cannot be read or is not JSON, and
  /// for an object with a key twice.
  explicit JsonFile(const std::filesystem::path& file);

  [[nodiscard]] JsonValue root() const { return {root_, *this, ""}; }
  [[nodiscard]] const std::string& name() const { return file_; }
  /// Returns the line on which an array or an object starts or another value ends, or, below three
  /// levels, that of the value around it.
  [[nodiscard]] std::size_t line_of(std::string path) const;

 private:
  std::string file_;
  Json root_;
  std::map<std::string, std::size_t> lines_;  // by path
};

}  // namespace raygate
