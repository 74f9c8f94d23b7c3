#include "host/app/format.h"

#include <cmath>
#include <cstdio>

namespace raygate {

std::string format_fixed(double value, int digits) {
  char text[400];  // the largest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string format_count(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string format_count(std::uint64_t count, const std::string& noun) {
  return format_count(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string format_duration(double seconds) {
  if (!(seconds >= 0.0) || seconds > 1e9) return "?";
  if (seconds < 59.95) {
    const bool milli = seconds < 0.9995;
    const double value = milli ? seconds * 1e3 : seconds;
    const int digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return format_fixed(value, digits) + (milli ? " ms" : " s");
  }
  const long whole = std::lround(seconds);
  const bool minutes = whole < 3600;
  const long small = minutes ? whole % 60 : whole % 3600 / 60;
  std::string text = std::to_string(minutes ? whole / 60 : whole / 3600);
  text += minutes ? " min " : " h ";
  if (small < 10) text += '0';
  return text + std::to_string(small) + (minutes ? " s" : " min");
}

std::string format_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value);
  return text;
}

}  // namespace raygate
