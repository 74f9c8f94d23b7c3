// JSON whose values know on which line they stand.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raygate {

/// A value of a JSON file, with what lies in it, and how to complain about it.
class JsonValue {
 public:
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };

  /// Parses `file`. Throws InputError, "file:line: what": what cannot be read or is not JSON (RFC
  /// 8259), a key that an object has twice, more than 64 levels.
  [[nodiscard]] static JsonValue read(const std::filesystem::path& file);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< from 1: where it ends or is opened

  // For the fitting kind alone.
  [[nodiscard]] bool boolean() const { return number_ != 0.0; }
  [[nodiscard]] double number() const { return number_; }  ///< may be infinite for 1e999
  [[nodiscard]] const std::string& string() const { return text_; }
  [[nodiscard]] const std::vector<JsonValue>& elements() const { return elements_; }
  /// Keys of an object, in the file's order; keys()[i] belongs to elements()[i].
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }

  /// "[1, 2]", "'text'", "an object": for messages.
  [[nodiscard]] std::string shown() const;

 private:
  friend class JsonTree;
  Kind kind_ = Kind::kNull;
  std::size_t line_ = 0;
  double number_ = 0.0;
  std::string text_;  ///< of a string; of a number as it stands in the file
  std::vector<JsonValue> elements_;
  std::vector<std::string> keys_;
};

}  // namespace raygate
