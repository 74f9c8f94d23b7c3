// Measurements: saturating counts, elapsed seconds per lap, and the processor time of the process.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <limits>

namespace raygate {

/// Adds `more`; saturates at the largest number instead of wrapping around.
inline void add_count(std::uint32_t& count, std::uint32_t more) {
  count += std::min(more, std::numeric_limits<std::uint32_t>::max() - count);
}

/// Returns the processor time of all threads of this process so far.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Measures consecutive laps.
class Stopwatch {
 public:
  /// Returns the seconds since the last call or, at the first call, since construction.
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
