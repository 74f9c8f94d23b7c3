// Values of a JSON file, asked for by what they must be.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "host/scene/io/located_json.h"

namespace raygate {

/// What a value may be. `name` is what a value is called in messages. All throw InputError,
/// "file:line: name: what was found, expected what".
class JsonReader {
 public:
  explicit JsonReader(const std::filesystem::path& file) : file_(file.string()) {}

  [[noreturn]] void fail(const JsonValue& value, const std::string& name,
                         const std::string& expected) const;

  /// The value of a key of an object; nullptr if it is not there.
  [[nodiscard]] static const JsonValue* find(const JsonValue& object, const std::string& key);

  /// An object that has no other keys than these.
  void require_object(const JsonValue& value, const std::string& name,
                      std::span<const char* const> known) const;

  /// The value of a key that must be there.
  [[nodiscard]] const JsonValue& need(const JsonValue& object, const std::string& name,
                                      const std::string& key) const;

  /// Within the range of float.
  [[nodiscard]] double number(const JsonValue& value, const std::string& name) const;
  /// From `low` to `high`, or what a missing key stands for; `expected` says so.
  [[nodiscard]] double number_in(const JsonValue& object, const std::string& name,
                                 const std::string& key, double low, double high,
                                 const std::string& expected, double missing) const;

  [[nodiscard]] glm::dvec3 vector(const JsonValue& value, const std::string& name) const;
  /// Of unit length; in the file of any length but 0.
  [[nodiscard]] glm::dvec3 direction(const JsonValue& value, const std::string& name) const;

  /// [r, g, b], or one number for all three; none negative.
  [[nodiscard]] glm::vec3 light(const JsonValue& value, const std::string& name) const;

  /// An array; no value is an empty one.
  [[nodiscard]] std::span<const JsonValue> array(const JsonValue* value,
                                                 const std::string& name) const;

 private:
  std::string file_;
};

}  // namespace raygate
