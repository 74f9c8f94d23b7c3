#include "host/scene/io/json_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/io/tokens.h"

namespace raygate {
namespace {

using Kind = JsonValue::Kind;

}  // namespace

void JsonReader::fail(const JsonValue& value, const std::string& name,
                      const std::string& expected) const {
  throw InputError(file_, value.line(), name + ": " + value.shown() + ", expected " + expected);
}

const JsonValue* JsonReader::find(const JsonValue& object, const std::string& key) {
  const auto& keys = object.keys();
  const auto found = std::ranges::find(keys, key);
  if (found == keys.end()) return nullptr;
  return &object.elements()[static_cast<std::size_t>(found - keys.begin())];
}

void JsonReader::require_object(const JsonValue& value, const std::string& name,
                                std::span<const char* const> known) const {
  std::string names;
  for (const char* key : known) names.append(names.empty() ? "" : ", ").append(key);
  if (value.kind() != Kind::kObject) fail(value, name, "an object with " + names);
  const auto unknown = std::ranges::find_if(value.keys(), [&](const std::string& key) {
    return std::ranges::find(known, key) == known.end();
  });
  if (unknown == value.keys().end()) return;
  const auto index = static_cast<std::size_t>(unknown - value.keys().begin());
  throw InputError(file_, value.elements()[index].line(),
                   name + ": unknown key " + in_quotes(*unknown) + ", expected some of " + names);
}

const JsonValue& JsonReader::need(const JsonValue& object, const std::string& name,
                                  const std::string& key) const {
  const JsonValue* const found = find(object, key);
  if (found == nullptr) {
    throw InputError(file_, object.line(), name + ": '" + key + "' is missing");
  }
  return *found;
}

double JsonReader::number(const JsonValue& value, const std::string& name) const {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (value.kind() != Kind::kNumber || !(std::abs(value.number()) <= kLargest)) {
    fail(value, name, "a number within the range of float");
  }
  return value.number();
}

double JsonReader::number_in(const JsonValue& object, const std::string& name,
                             const std::string& key, double low, double high,
                             const std::string& expected, double missing) const {
  const JsonValue* const value = find(object, key);
  if (value == nullptr) return missing;
  const double found = number(*value, name + "." + key);
  if (!(found >= low && found <= high)) fail(*value, name + "." + key, expected);
  return found;
}

glm::dvec3 JsonReader::vector(const JsonValue& value, const std::string& name) const {
  if (value.kind() != Kind::kArray || value.elements().size() != 3) {
    fail(value, name, "[x, y, z]");
  }
  glm::dvec3 xyz;
  for (int k = 0; k < 3; ++k) {
    xyz[k] = number(value.elements()[static_cast<std::size_t>(k)], name);
  }
  return xyz;
}

glm::dvec3 JsonReader::direction(const JsonValue& value, const std::string& name) const {
  const glm::dvec3 xyz = vector(value, name);
  if (xyz == glm::dvec3(0.0)) fail(value, name, "a direction: not all three 0");
  return glm::normalize(xyz / largest(xyz));
}

glm::vec3 JsonReader::light(const JsonValue& value, const std::string& name) const {
  const bool is_grey = value.kind() == Kind::kNumber;
  if (!is_grey && (value.kind() != Kind::kArray || value.elements().size() != 3)) {
    fail(value, name, "[red, green, blue] or one number for all three");
  }
  const glm::dvec3 rgb = is_grey ? glm::dvec3(number(value, name)) : vector(value, name);
  if (glm::min(rgb.x, glm::min(rgb.y, rgb.z)) < 0.0) fail(value, name, "no negative number");
  return glm::vec3(rgb);
}

std::span<const JsonValue> JsonReader::array(const JsonValue* value,
                                             const std::string& name) const {
  if (value == nullptr) return {};
  if (value->kind() != Kind::kArray) fail(*value, name, "an array");
  return value->elements();
}

}  // namespace raygate
