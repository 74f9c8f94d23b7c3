// Which tile is traced next.
#pragma once

#include <cassert>
#include <cstdint>
#include <deque>
#include <numeric>
#include <optional>
#include <vector>

namespace raygate {

/// Steps of a render: a pass over a tile each. A tile's passes follow one another, as its samples
/// are added up in their order; tiles do not wait for each other.
class Schedule {
 public:
  struct Step {
    int tile, pass;
  };

  Schedule(int tiles, int passes)
      : passes_(passes),
        steps_(std::int64_t{tiles} * passes),
        waiting_(static_cast<std::size_t>(tiles)),
        begun_of_(static_cast<std::size_t>(tiles), 0) {
    std::iota(waiting_.begin(), waiting_.end(), 0);
  }

  /// Begins a step; none where all tiles that have passes left are being traced, or none has.
  [[nodiscard]] std::optional<Step> begin() {
    if (waiting_.empty()) return std::nullopt;
    const int tile = waiting_.front();
    waiting_.pop_front();
    ++begun_;
    return Step{tile, begun_of_[static_cast<std::size_t>(tile)]++};
  }

  /// Ends the step of `tile` that was begun.
  void end(int tile) {
    ++ended_;
    assert(ended_ <= begun_);
    if (begun_of_[static_cast<std::size_t>(tile)] < passes_) waiting_.push_back(tile);
  }

  [[nodiscard]] bool all_begun() const { return begun_ == steps_; }
  [[nodiscard]] bool all_ended() const { return ended_ == steps_; }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(ended_) / static_cast<double>(steps_);
  }

 private:
  int passes_;
  std::int64_t steps_, begun_ = 0, ended_ = 0;
  std::deque<int> waiting_;
  std::vector<int> begun_of_;  // passes, by tile
};

}  // namespace raygate
