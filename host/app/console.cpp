#include "host/app/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
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

namespace {

constexpr int kWidestBar = 40;
constexpr std::string_view kEraseLine = "\r\x1b[K";

int terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

void show(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

/// Returns a duration in whole seconds, because it is an estimate.
std::string time_left(double seconds) {
  return seconds < 59.5 ? std::to_string(std::lround(seconds)) + " s" : format_duration(seconds);
}

/// " 45 %, 12 s left".
std::string state_of(double fraction, double elapsed) {
  std::string percent = std::to_string(static_cast<int>(100.0 * fraction));
  percent.insert(0, 3 - percent.size(), ' ');
  std::string state = percent + " %";
  // An estimate from less than 1 % of the work would be too coarse.
  if (fraction >= 0.01) {
    state += ", " + time_left(elapsed * (1.0 - fraction) / fraction) + " left";
  }
  return state;
}

}  // namespace

std::string progress_line(double fraction, double elapsed, int columns) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const std::string state = state_of(fraction, elapsed);
  const std::string title = "rendering ";
  // The bar keeps its length while the text after it changes.
  const int taken = static_cast<int>(title.size() + 3 + std::max<std::size_t>(state.size(), 24));
  const int room = std::min(kWidestBar, columns - 1 - taken);
  if (room < 5) return state.substr(0, static_cast<std::size_t>(std::max(0, columns - 1)));
  const auto done = static_cast<std::size_t>(fraction * room);
  std::string bar(done, '=');
  if (done < static_cast<std::size_t>(room)) bar += '>';
  bar.resize(static_cast<std::size_t>(room), ' ');
  return title + "[" + bar + "] " + state;
}

ProgressBar::ProgressBar(bool enabled) : enabled_(enabled && ::isatty(STDERR_FILENO) != 0) {}

void ProgressBar::erase() {
  if (drawn_) show(kEraseLine);
  drawn_ = false;
}

void ProgressBar::update(double fraction) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  show(std::string(kEraseLine) + progress_line(fraction, elapsed, terminal_columns()));
}

}  // namespace raygate
