// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace raygate {

/// "1,234,567".
[[nodiscard]] std::string format_count(std::uint64_t count);

/// "1 ray", "2,000 rays".
[[nodiscard]] std::string format_count(std::uint64_t count, const std::string& noun);

/// Three significant digits below a minute, then coarser: "0.123 ms", "12.3 s", "4 min 05 s",
/// "2 h 07 min". Negative or NaN: "?".
[[nodiscard]] std::string format_duration(double seconds);

/// `value` with `digits` decimals: "7.00".
[[nodiscard]] std::string format_fixed(double value, int digits);

/// `value` with at most seven digits that count: "35", "-0.125".
[[nodiscard]] std::string format_number(double value);

}  // namespace raygate
