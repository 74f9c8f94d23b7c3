#include "host/ranks/job_queue.h"

#include <chrono>

namespace raygate {
namespace {

constexpr std::chrono::milliseconds kLook{1};  // between looks for a message

}  // namespace

std::optional<int> JobQueue::next() {
  if (ranks_.index() != 0) {
    ranks_.send(0, About::kNext, {});
    while (true) {
      if (const auto message = ranks_.receive()) {
        const int job = value_of<int>(message->bytes);
        return job < count_ ? std::optional(job) : std::nullopt;
      }
      std::this_thread::sleep_for(kLook);
    }
  }
  if (ranks_.count() > 1 && !server_.joinable())
    server_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  const int job = next_++;
  if (job < count_ && !has_failed_) return job;
  if (server_.joinable()) server_.join();
  if (error_) std::rethrow_exception(error_);
  return std::nullopt;
}

/// Until each of the others has heard that there is no more.
void JobQueue::serve(const std::stop_token& stop) {
  try {
    for (int gone = 0; gone < ranks_.count() - 1 && !stop.stop_requested();) {
      if (const auto message = ranks_.receive()) {
        const int job = next_++;
        gone += static_cast<int>(job >= count_);
        ranks_.send(message->from, About::kJob, bytes_of(job));
      } else {
        std::this_thread::sleep_for(kLook);
      }
    }
  } catch (...) {
    error_ = std::current_exception();
    has_failed_ = true;
  }
}

}  // namespace raygate
