// The program as its shell sees it: standard streams, signals, exit status.
#pragma once

#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <string_view>

#include "host/ranks/ranks.h"

namespace raygate {

/// `text` as a terminal may have it: control characters, which file names can hold, become "\x1B"
/// and the like, and so do bytes that are not UTF-8. Newlines are kept if `newlines` says so.
[[nodiscard]] std::string printable(std::string_view text, bool newlines = false);

/// Prints `text`, made printable; newlines are kept.
void print(std::string_view text, std::FILE* stream = stdout);

/// Prints "warning: WHAT" on standard error, one line, made printable.
void print_warning(std::string_view what);

/// Throws InputError if what was printed cannot reach standard output: a full disk. A pipe that
/// nobody reads any more ends the program as SIGPIPE does.
void flush_standard_output();

/// What a program ends with that has thrown `error`: status 2 for InputError and where memory is
/// short, `internal_error` for a fault of ours, 128 + signal for Interrupted, for RankFailure that
/// rank's.
[[nodiscard]] Ending ending_of(const std::exception_ptr& error, int internal_error);

/// The body of main(): runs `program`, and turns what it throws into one line on standard error and
/// an exit status.
int run_guarded(const std::function<int()>& program, int internal_error);

/// Runs `work` on one of the ranks of a run. What it throws on any of them rank 0 throws.
void work_as_rank(Ranks& ranks, const std::function<void()>& work);

/// Settles which vector code runs (host/base/vectors.h). Throws InputError where RAYGATE_VECTORS
/// names none that this machine has.
void choose_vectors();

/// From now on SIGINT, SIGTERM and SIGHUP are only noted; a second one ends the program at once.
/// Signals that the program was started to ignore stay ignored.
void note_interruptions();

/// From now on SIGCONT is noted. mpirun sends it to all ranks when one of them has died, a second
/// before SIGTERM, which SIGKILL may follow within milliseconds.
void note_warnings();

/// Whether one came since this was asked last: time to save.
[[nodiscard]] bool take_warning();

/// The signal that was noted, or 0.
[[nodiscard]] int interruption();

/// What ends a run that was interrupted.
class Interrupted : public std::exception {
 public:
  /// `outcome` says what became of the files.
  Interrupted(int signal, const std::string& outcome)
      : signal_(signal), what_("interrupted; " + outcome) {}
  [[nodiscard]] int signal() const { return signal_; }
  [[nodiscard]] const char* what() const noexcept override { return what_.c_str(); }

 private:
  int signal_;
  std::string what_;
};

}  // namespace raygate
