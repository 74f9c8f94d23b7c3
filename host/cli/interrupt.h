// Ctrl-C while there is something to tidy up.
#pragma once

#include <exception>

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
  explicit Interrupted(int signal) : signal_(signal) {}
  [[nodiscard]] int signal() const { return signal_; }
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }

 private:
  int signal_;
};

}  // namespace raygate
