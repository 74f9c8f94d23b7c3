// Checkpoints: long work lets its caller end it early.
#pragma once

#include <functional>
#include <utility>

namespace raygate {

/// While a scope lives, checkpoint() on its thread calls `check`, which may throw to end the work.
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

/// Called by long work several times in 100 ms. Does nothing on threads without a scope.
inline void checkpoint() {
  if (const CheckpointScope* const scope = CheckpointScope::innermost()) scope->check_();
}

}  // namespace raygate
