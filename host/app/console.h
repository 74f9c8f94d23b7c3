// Console: numbers in words, and the progress of a render.
#pragma once

#include <chrono>
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

/// Returns "rendering: 45 %, 12.3 s left". `fraction`: the completed fraction, in [0, 1];
/// `elapsed`: seconds so far.
[[nodiscard]] std::string progress_text(double fraction, double elapsed);

/// A line about progress on standard error, redrawn in place and erased at the end. Silent if
/// standard error is not a terminal.
class ProgressLine {
 public:
  /// Starts the clock. Prints nothing unless `enabled`.
  explicit ProgressLine(bool enabled);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { erase(); }

  /// Erases the line so that another can be printed.
  void erase();

  /// Redraws the line, at most ten times a second. Not thread-safe.
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  bool enabled_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace raygate
