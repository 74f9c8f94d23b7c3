#include "host/app/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace raygate {
namespace {

constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

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

std::string progress_text(double fraction, double elapsed) {
  std::string text =
      "rendering: " + std::to_string(static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0))) +
      " %";
  // An estimate from less than 1 % of the work would be too coarse.
  if (fraction < 0.01) return text;
  return text + ", " + format_duration(elapsed * (1.0 - fraction) / fraction) + " left";
}

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled && ::isatty(STDERR_FILENO) != 0) {}

void ProgressLine::erase() {
  if (drawn_) std::fputs(kEraseLine, stderr);
  drawn_ = false;
}

void ProgressLine::update(double fraction) {
  const Clock::time_point now = Clock::now();
  if (!enabled_ || (drawn_ && now - last_ < std::chrono::milliseconds(100))) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "%s%s", kEraseLine, progress_text(fraction, elapsed).c_str());
}

}  // namespace raygate
