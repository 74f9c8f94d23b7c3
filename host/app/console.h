// Console: formatting and printing of messages, exit status, and signals.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

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

/// Returns "rendering: 45 %, 12.3 s left". `fraction`: done, in [0, 1]; `elapsed`: in seconds.
[[nodiscard]] std::string progress_text(double fraction, double elapsed);

/// A progress line on standard error, if this is a terminal. Redrawn in place; erased at the end.
class ProgressLine {
 public:
  /// Starts the clock. Prints nothing unless `enabled`.
  explicit ProgressLine(bool enabled);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { erase(); }

  /// Erases the line so that another line can be printed.
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

/// Returns text that is safe to print: control characters and bytes that are not UTF-8 become
/// "\x1B" and the like. Newlines are kept if `newlines`.
[[nodiscard]] std::string printable(std::string_view text, bool newlines = false);

/// Prints printable(text), with its newlines.
void print(std::string_view text, std::FILE* stream = stdout);

/// Prints "warning: WHAT", one printable line, on standard error.
void print_warning(std::string_view what);

/// Prints distinct warnings: the first ten and the number of the others, or, if `all`, all of them.
void print_warnings(const std::vector<std::string>& warnings, bool all);

/// Flushes standard output. Throws InputError if a write has failed, for example on a full disk. If
/// standard output is a pipe without a reader, raises SIGPIPE.
void flush_standard_output();

/// Thrown to end a program after --help or --version; what() is the text to print.
class Information : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs `program` and returns its exit status. Prints what() of Information. Other exceptions print
/// an error and give status 2 (InputError, no memory), 128 + signal (Interrupted) or 1.
int run_guarded(const std::function<int()>& program);

/// Body of main(): checks the machine's arithmetic, chooses vector code (RAYGATE_VECTORS) and runs
/// `program` with the command line's words by run_guarded(). Help shows argv[0]'s path.
int run_main(int argc, char** argv,
             const std::function<int(const std::vector<std::string>&)>& program);

/// The exit status after a signal is this plus the signal's number, as in shells.
inline constexpr int kSignalBase = 128;

/// Installs a handler of SIGINT, SIGTERM and SIGHUP; a second signal ends the program at once.
/// Signals that were ignored at the start stay ignored.
void handle_interruptions(void (*handler)(int));

/// Installs a handler, for the same signals, that records the signal for interruption().
void note_interruptions();

/// Returns the recorded signal, or 0.
[[nodiscard]] int interruption();

/// Thrown to end a run after a signal.
class Interrupted : public std::runtime_error {
 public:
  /// `outcome`: what happened to the output files, for the message.
  Interrupted(int number, const std::string& outcome)
      : std::runtime_error("interrupted; " + outcome), signal(number) {}

  const int signal;
};

}  // namespace raygate
