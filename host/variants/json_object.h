// Objects of JSON that say what differs from the usual.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace raygate {

using Json = nlohmann::ordered_json;

/// `object` with the values of `usual` where it has none. Throws InputError, "WHAT has ...": an
/// unknown name, or a value that is not of the usual one's kind.
[[nodiscard]] Json with_usual(const Json& object, Json usual, const std::string& what);

/// Throws InputError, "NAME is ..., expected LOW to HIGH".
int in_range(const std::string& name, int value, int low, int high);

}  // namespace raygate
