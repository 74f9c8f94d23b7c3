#include "host/variants/json_object.h"

#include "host/base/input_error.h"

namespace raygate {

Json with_usual(const Json& object, Json usual, const std::string& what) {
  if (!object.is_object()) throw InputError(what + " is " + object.dump() + ", not an object");
  for (const auto& [name, value] : object.items()) {
    if (!usual.contains(name)) {
      std::string text = what;
      text.append(" has ").append(name).append(", expected");
      for (const auto& item : usual.items()) text.append(" ").append(item.key());
      throw InputError(text);
    }
    const Json& like = usual[name];
    const bool same_kind = like.is_number_float() ? value.is_number()
                           : like.is_number()     ? value.is_number_integer()
                                                  : value.type() == like.type();
    if (!same_kind) {
      throw InputError(name + " is " + value.dump() + ", expected a value like " + like.dump());
    }
  }
  usual.update(object);
  return usual;
}

int in_range(const std::string& name, int value, int low, int high) {
  if (low <= value && value <= high) return value;
  throw InputError(name + " is " + std::to_string(value) + ", expected " + std::to_string(low) +
                   " to " + std::to_string(high));
}

}  // namespace raygate
