#include "host/cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace raygate {
namespace {

std::atomic<int> noted_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free, "signal handlers may use nothing else");

void note(int signal) { noted_signal = signal; }

}  // namespace

InterruptGuard::InterruptGuard() {
  noted_signal = 0;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);  // the second one kills
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction old {};
    // A program started in the background with its signals ignored keeps ignoring them.
    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) {
      ::sigaction(signal, &action, nullptr);
    }
  }
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == note) {
      std::signal(signal, SIG_DFL);
    }
  }
}

int InterruptGuard::signal() { return noted_signal; }

}  // namespace raygate
