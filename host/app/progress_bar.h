// Progress bar of a render.
#pragma once

#include <chrono>
#include <string>

namespace raygate {

/// Returns "rendering [=========>          ]  45 %, 12 s left" with at most `columns` characters,
/// without the bar if it does not fit. `fraction`: the completed fraction, in [0, 1]; `elapsed`:
/// seconds so far.
[[nodiscard]] std::string progress_line(double fraction, double elapsed, int columns);

/// A progress bar on standard error that is erased at the end. kBar: redrawn in place; silent if
/// standard error is not a terminal. kLines, for launchers that forward lines: a line at the start
/// and one for each tenth of the work.
class ProgressBar {
 public:
  enum class Style { kBar, kLines };

  /// Starts the clock. Prints nothing unless `enabled`.
  explicit ProgressBar(bool enabled, Style style = Style::kBar);
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
  Style style_;
  int tenths_ = -1;  // already printed
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace raygate
