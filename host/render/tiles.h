// Tiles: splits an image into tiles of pixels and passes of samples, and queues the passes.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/glm.hpp>
#include <optional>

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/scene/camera.h"

namespace raygate {

/// A window split into tiles, numbered row by row, and each pixel's samples split into passes. A
/// pass over a tile has about the number of samples that an intersector prefers in a batch. Tiles
/// are smaller if there would be fewer tiles than threads.
struct Tiles {
  PixelRect window;
  int samples, samples_per_pass;
  int width, height;  ///< of a tile
  int columns, count;

  /// `batch` is EngineTraits::batch.
  Tiles(const PixelRect& rect, int samples_per_pixel, std::size_t batch, int threads)
      : window(rect), samples(samples_per_pixel), samples_per_pass(std::min(samples_per_pixel, 4)) {
    const int edge = samples_per_pass == 1 ? 128 : samples_per_pass < 4 ? 80 : 64;
    const std::int64_t share = std::int64_t{window.width()} * window.height() / threads;
    const int square = edge * edge;
    const auto many = static_cast<std::int64_t>(batch) / samples_per_pass;
    const int pixels = static_cast<int>(
        std::clamp(share, std::int64_t{square}, std::max<std::int64_t>(square, many)));
    width = pixels / edge;
    // Tiles consist of squares of 8 x 8 pixels, which are traced together.
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

/// Queue of the steps of a render. A step is a pass over a tile. The passes of a tile are
/// sequential; tiles are independent.
class TileQueue {
 public:
  struct Step {
    int tile, pass;
  };

  TileQueue(int tiles, int passes) : passes_(passes), steps_(std::int64_t{tiles} * passes) {
    for (int tile = 0; tile < tiles; ++tile) waiting_.push_back({tile, 0});
  }

  /// Begins the step that has waited longest. Returns nullopt if no step waits.
  [[nodiscard]] std::optional<Step> begin() {
    if (waiting_.empty()) return std::nullopt;
    const Step step = waiting_.front();
    waiting_.pop_front();
    ++begun_;
    return step;
  }

  /// Ends a step that was begun; the next pass of its tile can begin.
  void end(const Step& step) {
    ++ended_;
    assert(ended_ <= begun_);
    if (step.pass + 1 < passes_) waiting_.push_back({step.tile, step.pass + 1});
  }

  [[nodiscard]] bool all_begun() const { return begun_ == steps_; }
  [[nodiscard]] bool all_ended() const { return ended_ == steps_; }
  [[nodiscard]] double fraction() const {
    return static_cast<double>(ended_) / static_cast<double>(steps_);
  }

 private:
  int passes_;
  std::int64_t steps_, begun_ = 0, ended_ = 0;
  std::deque<Step> waiting_;
};

/// Returns whether a camera ray through `tile`, or up to `margin` pixels beside it, may enter a
/// leaf of the BVH. Conservative: false means that no such ray does, however it is rounded.
[[nodiscard]] bool may_see_anything(const Bvh& bvh, const Camera& camera, const Film& film,
                                    const PixelRect& tile, double margin);

/// Like may_see_anything(), but for the box from `low` to `high` instead of a leaf.
[[nodiscard]] bool may_see_box(const glm::vec3& low, const glm::vec3& high, const Camera& camera,
                               const Film& film, const PixelRect& tile, double margin);

}  // namespace raygate
