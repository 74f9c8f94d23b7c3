// Progress bar of a render.
#pragma once

#include <chrono>
#include <string>

namespace raygate {

/// "rendering [=========>          ]  45 %, 12 s left", within `columns` characters (without the
/// bar where it has no room). `fraction` in [0, 1]; `elapsed` seconds brought it there.
[[nodiscard]] std::string progress_line(double fraction, double elapsed, int columns);

/// A line on standard error that is redrawn as the work goes on, and gone when it is over. Silent
/// where standard error is no terminal. Or, through a launcher that hands lines on, one at the
/// beginning and one for each tenth of the work.
class ProgressBar {
 public:
  enum class Style { kBar, kLines };

  /// `enabled` false: silent on terminals too. The clock starts here.
  explicit ProgressBar(bool enabled, Style style = Style::kBar);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { erase(); }

  /// Removes the line, for another one to be printed.
  void erase();

  /// Redraws the line, at most ten times a second. From one thread at a time.
  void update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  bool enabled_;
  Style style_;
  int tenths_ = -1;  // printed
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_;
};

}  // namespace raygate
