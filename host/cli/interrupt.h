// Ctrl-C while there is something to tidy up.
#pragma once

#include <exception>
#include <string>

namespace raygate {

/// While one of these lives, SIGINT and SIGTERM are only noted; a second one ends the program at
/// once. At most one at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();

  /// The signal that came, or 0.
  [[nodiscard]] static int signal();
};

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
