// Numbered jobs that ranks take one after the other.
#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <stop_token>
#include <thread>

#include "host/ranks/ranks.h"

namespace raygate {

/// Jobs 0 to count - 1: each goes to the rank that asks first. Rank 0 hands the numbers out on a
/// thread of its own while it works on jobs itself. All ranks make one of the same count; nobody
/// else may use `ranks` meanwhile.
class JobQueue {
 public:
  JobQueue(Ranks& ranks, int count) : ranks_(ranks), count_(count) {}
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// A job for this rank; none when all have been begun. On rank 0 not before those of the other
  /// ranks have ended, or one of them could not go on; then throws what receive() does.
  [[nodiscard]] std::optional<int> next();

 private:
  void serve(const std::stop_token& stop);

  Ranks& ranks_;
  int count_;
  std::atomic<int> next_ = 0;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr error_;
  std::jthread server_;  // last: it uses the others
};

}  // namespace raygate
