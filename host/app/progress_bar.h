// Progress bar of a render.
#pragma once

#include <chrono>
#include <string>

namespace raygate {

/// Returns "rendering [=========>          ]  45 %, 12 s left" with at most `columns` characters,
/// without the bar if it does not fit. `fraction`: the completed fraction, in [0, 1]; `elapsed`:
/// seconds so far.
[[nodiscard]] std::string progress_line(double fraction, double elapsed, int columns);

/// A progress bar on standard error, redrawn in place and erased at the end. Silent if standard
/// error is not a terminal.
class ProgressBar {
 public:
  /// Starts the clock. Prints nothing unless `enabled`.
  explicit ProgressBar(bool enabled);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { erase(); }

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
