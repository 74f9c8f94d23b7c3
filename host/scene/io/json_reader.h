// JSON values that know their line and their path, asked for by what they must be.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace raygate {

/// A value as it stands in a JSON file.
struct JsonNode {
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };

  Kind kind = Kind::kNull;
  std::size_t line = 0;  ///< from 1: where it ends or is opened
  double number = 0.0;   ///< of a bool 0 or 1; may be infinite for 1e999
  std::string text;      ///< of a string; of a number as it stands in the file
  std::vector<JsonNode> elements;
  std::vector<std::string> keys;  ///< of an object, in the file's order: those of `elements`
};

/// A value of a JsonFile, which must outlive this. A value that is not what it is asked for throws
/// InputError: "a.json:7: camera.eye[1]: 'up', expected a number within the range of float".
class JsonValue {
 public:
  [[noreturn]] void fail(const std::string& expected) const;
  [[nodiscard]] std::size_t line() const { return node_->line; }

  /// An object that has no other keys than these.
  void require_keys(std::span<const char* const> known) const;
  void require_keys(std::initializer_list<const char*> known) const {
    require_keys(std::span(known.begin(), known.size()));
  }
  [[nodiscard]] const std::vector<std::string>& keys() const { return node_->keys; }
  /// The value of a key of an object; nothing if it is not there.
  [[nodiscard]] std::optional<JsonValue> find(const std::string& key) const;
  /// The value of a key that must be there.
  [[nodiscard]] JsonValue at(const std::string& key) const;

  /// Of an array.
  [[nodiscard]] std::vector<JsonValue> elements() const;
  /// Of the array of a key; none if it is not there.
  [[nodiscard]] std::vector<JsonValue> elements(const std::string& key) const;

  /// Within the range of float.
  [[nodiscard]] double number() const;
  /// Of a key, from `low` to `high`, or what a missing key stands for; `expected` says so.
  [[nodiscard]] double number_in(const std::string& key, double low, double high,
                                 const std::string& expected, double missing) const;
  /// Not empty; `expected` says what it names.
  [[nodiscard]] const std::string& string(const std::string& expected) const;
  /// A number or a string as it stands in the file.
  [[nodiscard]] const std::string& word(const std::string& expected) const;
  /// [x, y, z]
  [[nodiscard]] glm::dvec3 vector() const;
  /// Of unit length; in the file of any length but 0.
  [[nodiscard]] glm::dvec3 direction() const;
  /// [red, green, blue], or one number for all three; none negative.
  [[nodiscard]] glm::vec3 light() const;

 private:
  friend class JsonFile;
  JsonValue(const JsonNode& node, const std::string& file, std::string path)
      : node_(&node), file_(&file), path_(std::move(path)) {}

  [[nodiscard]] std::string name() const { return path_.empty() ? "scene" : path_; }

  const JsonNode* node_;
  const std::string* file_;
  std::string path_;  // from the root, as in "lights[2].edges"
};

class JsonFile {
 public:
  /// Parses `file`. Throws InputError, "file:line: what": what cannot be read or is not JSON (RFC
  /// 8259), a key that an object has twice, more than 64 levels.
  explicit JsonFile(const std::filesystem::path& file);

  [[nodiscard]] JsonValue root() const { return {root_, file_, ""}; }

 private:
  std::string file_;
  JsonNode root_;
};

}  // namespace raygate
