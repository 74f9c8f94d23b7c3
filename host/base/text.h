// Words of texts: numbers, and quotes for messages.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace raygate {

/// Returns the word in quotes for a message: its first 40 characters, with unprintable ones as
/// \xHH.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Returns a decimal number as the nearest double, in any locale, or nullopt if the whole word is
/// not a number. "nan" and "inf" are numbers; a magnitude too large gives infinity, too small 0.
[[nodiscard]] std::optional<double> to_number(std::string_view word);

}  // namespace raygate
