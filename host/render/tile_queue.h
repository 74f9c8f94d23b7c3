// Tile queue: which tile is traced next, and by which rank.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <deque>
#include <numeric>
#include <optional>
#include <vector>

namespace raygate {

/// Steps of a render: passes over a tile. A tile's passes follow one another, as its samples
/// are added up in their order; tiles do not wait for each other. A tile stays with the rank that
/// has begun it as long as there is another one for whoever asks: what there is of it need not
/// travel then.
class TileQueue {
 public:
  struct Step {
    int tile, pass, end_pass;  ///< passes [pass, end_pass)
    bool moves;                ///< from another rank, which had the pass before
  };

  /// `is_begun`: rank 0 has something of all tiles, from an earlier run.
  TileQueue(int tiles, int passes, bool is_begun = false)
      : passes_(passes),
        steps_(std::int64_t{tiles} * passes),
        waiting_(static_cast<std::size_t>(tiles)),
        tiles_(static_cast<std::size_t>(tiles), {.rank = is_begun ? 0 : kNobody}) {
    std::iota(waiting_.begin(), waiting_.end(), 0);
  }

  /// Begins up to `most` passes, at least one, of a tile; none where all tiles that have passes
  /// left are being traced, or none has.
  [[nodiscard]] std::optional<Step> begin(int rank = 0, int most = 1) {
    if (waiting_.empty()) return std::nullopt;
    const auto may_stay = [&](int tile) {
      const int with = at(tile).rank;
      return with == rank || with == kNobody;
    };
    auto next = std::ranges::find_if(waiting_, may_stay);
    if (next == waiting_.end()) next = waiting_.begin();
    Step step{*next, at(*next).begun, 0, !may_stay(*next)};
    waiting_.erase(next);
    step.end_pass = std::min(passes_, step.pass + std::max(1, most));
    begun_ += step.end_pass - step.pass;
    at(step.tile).begun = step.end_pass;
    at(step.tile).rank = rank;
    return step;
  }

  /// Ends the step of `tile` that was begun.
  void end(int tile) {
    Tile& ended = at(tile);
    ended_ += ended.begun - ended.ended;
    assert(ended_ <= begun_);
    ended.ended = ended.begun;
    if (ended.begun < passes_) waiting_.push_back(tile);
  }

  [[nodiscard]] bool all_begun() const { return begun_ == steps_; }
  [[nodiscard]] bool all_ended() const { return ended_ == steps_; }
  /// Passes over a tile that nobody has begun.
  [[nodiscard]] std::int64_t left() const { return steps_ - begun_; }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(ended_) / static_cast<double>(steps_);
  }

 private:
  static constexpr int kNobody = -1;
  struct Tile {
    int rank = kNobody;        // which has what there is of it
    int begun = 0, ended = 0;  // passes
  };
  [[nodiscard]] Tile& at(int tile) { return tiles_[static_cast<std::size_t>(tile)]; }

  int passes_;
  std::int64_t steps_, begun_ = 0, ended_ = 0;
  std::deque<int> waiting_;
  std::vector<Tile> tiles_;
};

}  // namespace raygate
