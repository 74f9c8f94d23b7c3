// Checkpoints: let callers end long work early.
#pragma once

#include <functional>
#include <utility>

namespace raygate {

/// During its lifetime, checkpoint() on its thread calls `check`, which may throw to end the work.
class CheckpointScope {
 public:
  explicit CheckpointScope(std::function<void()> check)
      : check_(std::move(check)), outer_(std::exchange(innermost(), this)) {}
  CheckpointScope(const CheckpointScope&) = delete;
  CheckpointScope& operator=(const CheckpointScope&) = delete;
  ~CheckpointScope() { innermost() = outer_; }

 private:
  friend void checkpoint();

  static CheckpointScope*& innermost() {
    thread_local CheckpointScope* scope = nullptr;
    return scope;
  }

  std::function<void()> check_;
  CheckpointScope* outer_;
};

/// Calls this thread's innermost check, if any. Long work calls it several times per 100 ms.
inline void checkpoint() {
  if (const CheckpointScope* const scope = CheckpointScope::innermost()) scope->check_();
}

}  // namespace raygate
