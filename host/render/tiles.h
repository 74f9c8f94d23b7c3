// Tiles: splits an image into tiles of pixels and passes of samples; and the queue of this work.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <numeric>
#include <optional>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/scene/camera.h"

namespace raygate {

/// The window split into tiles, numbered row by row, and each pixel's samples into passes, such
/// that a pass over a tile has about the number of samples that an intersector prefers in a batch.
/// Tiles are smaller if otherwise some threads would have none. With several ranks tiles are
/// smaller and passes longer (unless `short_passes`) while a thread would have fewer than four
/// tiles.
struct Tiles {
  PixelRect window;
  int samples, samples_per_pass;
  int width, height;  ///< of a tile
  int columns, count;

  /// `batch` is Intersector::preferred_batch(). `threads` is per rank.
  Tiles(const PixelRect& rect, int samples_per_pixel, std::size_t batch, int threads, int ranks = 1,
        bool short_passes = false)
      : window(rect), samples(samples_per_pixel), samples_per_pass(std::min(samples_per_pixel, 4)) {
    int edge = samples_per_pass == 1 ? 128 : samples_per_pass < 4 ? 80 : 64;
    const std::int64_t share =
        std::int64_t{window.width()} * window.height() / (std::int64_t{threads} * ranks);
    for (; ranks > 1 && edge > 16 && share < std::int64_t{4} * edge * edge; edge /= 2) {
      if (!short_passes) samples_per_pass = std::min(samples, 4 * samples_per_pass);
    }
    const int square = edge * edge;
    const auto many = static_cast<std::int64_t>(batch) / samples_per_pass;
    const int pixels = static_cast<int>(
        std::clamp(share, std::int64_t{square}, std::max<std::int64_t>(square, many)));
    width = pixels / edge;
    // Whole squares of 8 x 8 pixels, which are traced together.
    width = (width + 7) / 8 * 8;
    if (2 * width > window.width()) width = window.width();
    height = (pixels / width + 7) / 8 * 8;
    columns = (window.width() + width - 1) / width;
    count = columns * ((window.height() + height - 1) / height);
  }

  [[nodiscard]] int passes() const { return (samples + samples_per_pass - 1) / samples_per_pass; }
  /// Returns the number of samples that a pixel has after a pass.
  [[nodiscard]] int samples_after(int pass) const {
    return std::min(samples, (pass + 1) * samples_per_pass);
  }

  [[nodiscard]] PixelRect operator[](int index) const {
    const int x = window.x0 + index % columns * width;
    const int y = window.y0 + index / columns * height;
    return {x, y, std::min(x + width, window.x1), std::min(y + height, window.y1)};
  }
};

/// The steps of a render, each one or more passes over a tile. The passes of a tile are sequential;
/// tiles are independent. A tile stays with its rank while other tiles are left for other ranks, so
/// that its pixels need not be sent.
class TileQueue {
 public:
  struct Step {
    int tile, pass, end_pass;  ///< passes [pass, end_pass)
    bool moves;                ///< another rank rendered the previous pass
  };

  /// `is_begun`: rank 0 has samples of all tiles from an earlier run.
  TileQueue(int tiles, int passes, bool is_begun = false)
      : passes_(passes),
        steps_(std::int64_t{tiles} * passes),
        waiting_(static_cast<std::size_t>(tiles)),
        tiles_(static_cast<std::size_t>(tiles), {.rank = is_begun ? 0 : kNobody}) {
    std::iota(waiting_.begin(), waiting_.end(), 0);
  }

  /// Begins up to `most` passes of a tile. Returns nullopt if all are complete or being rendered.
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

  /// Ends the current step of `tile`.
  void end(int tile) {
    Tile& ended = at(tile);
    ended_ += ended.begun - ended.ended;
    assert(ended_ <= begun_);
    ended.ended = ended.begun;
    if (ended.begun < passes_) waiting_.push_back(tile);
  }

  [[nodiscard]] bool all_begun() const { return begun_ == steps_; }
  [[nodiscard]] bool all_ended() const { return ended_ == steps_; }
  /// Returns the number of passes that have not begun.
  [[nodiscard]] std::int64_t left() const { return steps_ - begun_; }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(ended_) / static_cast<double>(steps_);
  }

 private:
  static constexpr int kNobody = -1;
  struct Tile {
    int rank = kNobody;        // the rank that has its samples
    int begun = 0, ended = 0;  // numbers of passes
  };
  [[nodiscard]] Tile& at(int tile) { return tiles_[static_cast<std::size_t>(tile)]; }

  int passes_;
  std::int64_t steps_, begun_ = 0, ended_ = 0;
  std::deque<int> waiting_;
  std::vector<Tile> tiles_;
};

/// Returns whether a camera ray through `tile`, or up to `margin` pixels beside it, may enter a
/// leaf of the BVH. Conservative: false only if no ray does, including all rounding.
[[nodiscard]] bool may_see_anything(const Bvh& bvh, const Camera& camera, const Film& film,
                                    const PixelRect& tile, double margin);

/// Returns whether such a camera ray may enter the box from `low` to `high`.
[[nodiscard]] bool may_see_box(const glm::vec3& low, const glm::vec3& high, const Camera& camera,
                               const Film& film, const PixelRect& tile, double margin);

}  // namespace raygate
