// Memory of a simulated ray core, with latency, limited bandwidth, a cache and reordered answers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <queue>
#include <random>
#include <span>
#include <vector>

#include "host/intersect/core/memory_image.h"
#include "sim/memory_timing.h"

namespace raygate {

/// Memory of numbered lines. Takes a request and returns a line, with its request's tag, per clock.
class MemoryModel {
 public:
  explicit MemoryModel(const MemoryTiming& timing)
      : timing_(timing),
        random_(timing.seed),
        cached_(static_cast<std::size_t>(timing.cache_lines), kNothing) {}

  /// Sets the memory's contents; only while no line is in flight.
  void load(std::span<const MemoryLine> lines) {
    std::ranges::fill(cached_, kNothing);
    lines_ = lines;
  }

  /// Advances by a clock.
  void clock() {
    ++now_;
    ready_ = now_ >= free_at_ &&
             (timing_.not_taken == 0 || static_cast<int>(random_() & 0xFF) >= timing_.not_taken);
  }

  /// Returns whether a request would be taken in this clock.
  [[nodiscard]] bool ready() const { return ready_; }
  /// Takes a request. Requests for lines beyond the last one are answered with an error.
  void read(std::uint32_t line, std::uint64_t tag) {
    int latency = timing_.latency;
    if (!cached_.empty()) {
      std::uint32_t& held = cached_[line & (cached_.size() - 1)];
      if (held == line) latency = timing_.cache_latency;
      if (held != line) ++misses_;
      held = line;
    } else {
      ++misses_;
    }
    if (timing_.disorder != 0)
      latency += static_cast<int>(random_() % static_cast<std::uint64_t>(timing_.disorder + 1));
    due_.push({now_ + static_cast<std::uint64_t>(latency), sent_++, line, tag});
    free_at_ = now_ + static_cast<std::uint64_t>(64 / timing_.bytes);
  }

  /// Returns whether a line is available in this clock. The next functions describe this line.
  [[nodiscard]] bool valid() const { return !due_.empty() && due_.top().at <= now_; }
  [[nodiscard]] std::uint32_t number() const { return due_.top().line; }
  [[nodiscard]] bool is_error() const { return number() >= lines_.size(); }
  /// Returns the line, or zeros if is_error().
  [[nodiscard]] MemoryLine line() const { return is_error() ? MemoryLine{} : lines_[number()]; }
  [[nodiscard]] std::uint64_t tag() const { return due_.top().tag; }
  void pop() { due_.pop(); }

  /// Returns whether no line is in flight.
  [[nodiscard]] bool is_idle() const { return due_.empty(); }

  /// Returns the number of cache misses; without a cache, the number of requests.
  [[nodiscard]] std::uint64_t misses() const { return misses_; }

 private:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFF;

  struct Due {
    std::uint64_t at, number;
    std::uint32_t line;
    std::uint64_t tag;

    /// Orders std::priority_queue so that its top is the line due first.
    friend bool operator<(const Due& a, const Due& b) {
      return a.at != b.at ? a.at > b.at : a.number > b.number;
    }
  };

  std::span<const MemoryLine> lines_;
  MemoryTiming timing_;
  std::mt19937_64 random_;
  std::vector<std::uint32_t> cached_;
  std::priority_queue<Due> due_;
  std::uint64_t now_ = 0, free_at_ = 0, sent_ = 0, misses_ = 0;
  bool ready_ = true;
};

}  // namespace raygate
