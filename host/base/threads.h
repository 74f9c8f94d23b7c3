// Parallel loops over several threads, and checkpoints at which work can be ended early.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace raygate {

/// During its lifetime, checkpoint() on the same thread calls `check`, which may throw to end work.
class CheckpointScope {
 public:
  explicit CheckpointScope(std::function<void()> check)
      : check_(std::move(check)), outer_(std::exchange(innermost_, this)) {}
  CheckpointScope(const CheckpointScope&) = delete;
  CheckpointScope& operator=(const CheckpointScope&) = delete;
  ~CheckpointScope() { innermost_ = outer_; }

 private:
  friend void checkpoint();

  static inline thread_local CheckpointScope* innermost_ = nullptr;
  std::function<void()> check_;
  CheckpointScope* outer_;
};

/// Calls this thread's innermost check, if any. Long work calls it several times per 100 ms.
inline void checkpoint() {
  if (CheckpointScope::innermost_ != nullptr) CheckpointScope::innermost_->check_();
}

/// Calls work(i) once for each i below `count`, in any order, on up to `threads` threads including
/// the caller's, and waits for all. Uses fewer threads if the system cannot start as many. An
/// exception ends the work of all threads early; rethrows the first exception.
template <class Work>
void for_each_on_threads(int threads, std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto run = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) {
        checkpoint();
        work(i);
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (int i = 1; i < threads && static_cast<std::size_t>(i) < count; ++i) {
        others.emplace_back(run);
      }
    } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): fewer suffice
    }
    run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace raygate
