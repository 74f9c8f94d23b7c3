// Runs work on several threads, including the caller's.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "host/base/checkpoint.h"

namespace raygate {

/// Calls `work` on up to `threads` threads at once, including the caller's, and waits for all. Uses
/// fewer if the system cannot start as many. Rethrows the first exception of any thread.
template <class Work>
void on_threads(int threads, const Work& work) {
  std::mutex mutex;
  std::exception_ptr error;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (int i = 1; i < threads; ++i) others.emplace_back(guarded);
    } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): these will do
    }
    guarded();
  }
  if (error) std::rethrow_exception(error);
}

/// Calls work(i) once for each i below `count`, in any order. An exception ends the others early.
template <class Work>
void for_each_on_threads(int threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto most = static_cast<int>(std::min<std::size_t>(count, 1 << 16));
  on_threads(std::min(threads, most), [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        checkpoint();
        work(i);
      }
    } catch (...) {
      next = count;
      throw;
    }
  });
}

}  // namespace raygate
