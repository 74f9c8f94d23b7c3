// Stopwatch: wall-clock seconds lap by lap; and the processor time of the program.
#pragma once

#include <chrono>
#include <ctime>

namespace raygate {

/// Processor time of all threads so far: what other programs take does not count.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Each lap ends one part and begins the next.
class Stopwatch {
 public:
  /// Seconds since construction or the last lap.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - start_;
    start_ = now;
    return elapsed.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace raygate
