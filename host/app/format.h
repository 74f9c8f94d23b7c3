// Formatting of numbers for people.
#pragma once

#include <cstdint>
#include <string>

namespace raygate {

/// Returns "1,234,567".
[[nodiscard]] std::string format_count(std::uint64_t count);

/// Returns "1 ray" or "2,000 rays".
[[nodiscard]] std::string format_count(std::uint64_t count, const std::string& noun);

/// Returns "0.123 ms", "12.3 s" (three significant digits below a minute), "4 min 05 s" or
/// "2 h 07 min"; "?" for negative values and NaN.
[[nodiscard]] std::string format_duration(double seconds);

/// Returns `value` with `digits` decimals: "7.00".
[[nodiscard]] std::string format_fixed(double value, int digits);

/// Returns `value` with at most seven significant digits: "35", "-0.125".
[[nodiscard]] std::string format_number(double value);

}  // namespace raygate
