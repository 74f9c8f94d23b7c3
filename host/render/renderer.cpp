#include "host/render/renderer.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "host/render/record_cache.h"
#include "host/render/shade.h"
#include "host/render/stopwatch.h"
#include "host/render/wavefront.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

// Pixels. 16,384 rays in flight: a batch of their tests is long against the 50 clocks that the
// pipelined unit takes to run empty at its end, also when 8 lanes share it.
constexpr int kTileSize = 128;
// Pixels of a packet: eight rays close together, for the boxes to agree about.
constexpr int kBlockWidth = 4, kBlockHeight = kLanes / kBlockWidth;

int divided_up(int value, int by) { return (value + by - 1) / by; }

/// The window cut into tiles, numbered row by row.
struct Tiles {
  PixelRect window;
  int columns, count;

  explicit Tiles(const PixelRect& rect)
      : window(rect),
        columns(divided_up(rect.width(), kTileSize)),
        count(columns * divided_up(rect.height(), kTileSize)) {}

  [[nodiscard]] PixelRect operator[](int index) const {
    const int x = window.x0 + index % columns * kTileSize;
    const int y = window.y0 + index / columns * kTileSize;
    return {x, y, std::min(x + kTileSize, window.x1), std::min(y + kTileSize, window.y1)};
  }
};

Film empty_film(const RenderOptions& options) {
  Film film;
  film.width = options.width;
  film.height = options.height;
  film.window = options.window;
  if (film.window.width() <= 0 || film.window.height() <= 0) {
    film.window = {0, 0, options.width, options.height};
  }
  assert(film.window.x0 >= 0 && film.window.x1 <= film.width);
  assert(film.window.y0 >= 0 && film.window.y1 <= film.height);
  const std::size_t pixels = std::size_t(film.window.width()) * std::size_t(film.window.height());
  film.color.assign(pixels, glm::vec4(0.0f));
  film.depth.assign(pixels, std::numeric_limits<float>::infinity());
  film.normal.assign(pixels, glm::vec3(0.0f));
  film.primitive.assign(pixels, kNoPrimitive);
  return film;
}

/// One thread's share of a render: tile after tile.
class Worker {
 public:
  Worker(const Scene& scene, const Bvh& bvh, const Camera& camera, RecordCache& records,
         HitTester& tester, Film& film)
      : scene_(scene),
        bvh_(bvh),
        camera_(camera),
        records_(records),
        tester_(tester),
        film_(film),
        wavefront_(bvh, tester) {}

  void render(const PixelRect& tile) {
    Stopwatch watch;
    make_rays(tile);
    stats_.shade_seconds += watch.lap();
    wavefront_.trace(camera_.eye(), directions_, records_);
    watch.lap();
    for (std::size_t i = 0; i < pixels_.size(); ++i) write_pixel(i);
    stats_.shade_seconds += watch.lap();
    stats_.rays += pixels_.size();
  }

  void add_to(RenderStats& stats) const {
    stats.rays += stats_.rays;
    stats.hit += tester_.counters();
    stats.exact_inside += wavefront_.counters().exact_inside;
    stats.exact_depth += wavefront_.counters().exact_depth;
    stats.traverse_seconds += wavefront_.seconds().traverse;
    stats.hit_seconds += wavefront_.seconds().hit;
    stats.doubt_seconds += wavefront_.seconds().doubt;
    stats.shade_seconds += stats_.shade_seconds;
  }

 private:
  /// Block by block, so that the wavefront's packets are blocks.
  void make_rays(const PixelRect& tile) {
    directions_.clear();
    pixels_.clear();
    for (int block_y = tile.y0; block_y < tile.y1; block_y += kBlockHeight) {
      for (int block_x = tile.x0; block_x < tile.x1; block_x += kBlockWidth) {
        for (int y = block_y; y < std::min(block_y + kBlockHeight, tile.y1); ++y) {
          for (int x = block_x; x < std::min(block_x + kBlockWidth, tile.x1); ++x) {
            directions_.push_back(
                camera_.direction((x + 0.5) / film_.width, (y + 0.5) / film_.height));
            pixels_.push_back(std::size_t(y - film_.window.y0) * film_.window.width() +
                              std::size_t(x - film_.window.x0));
          }
        }
      }
    }
  }

  void write_pixel(std::size_t ray) {
    const NearestHit& hit = wavefront_.nearest(ray);
    if (hit.slot == NearestHit::kNone) return;
    const std::uint32_t index = bvh_.triangle_of(hit.slot);
    const Appearance look = shade(scene_, scene_.triangles[index], bvh_.corners_of(hit.slot),
                                  {camera_.eye(), directions_[ray]});
    const std::size_t pixel = pixels_[ray];
    film_.color[pixel] = glm::vec4(look.color, 1.0f);
    film_.depth[pixel] = static_cast<float>(glm::dot(glm::dvec3(hit.point), camera_.forward()));
    film_.normal[pixel] = look.normal;
    film_.primitive[pixel] = index;
  }

  const Scene& scene_;
  const Bvh& bvh_;
  const Camera& camera_;
  RecordCache& records_;
  HitTester& tester_;
  Film& film_;
  Wavefront wavefront_;
  RenderStats stats_;
  std::vector<glm::vec3> directions_;
  std::vector<std::size_t> pixels_;  // where in the film each ray's pixel is
};

/// What the threads share besides the film.
struct Progress {
  explicit Progress(const ProgressFunction& function) : report(function) {}

  const ProgressFunction& report;
  std::mutex mutex;  // of report, done, error and the statistics
  int done = 0;
  std::exception_ptr error;
  std::atomic<int> next_tile{0};
  std::atomic<bool> stop{false};

  void tile_done(int count) {
    const std::scoped_lock lock(mutex);
    ++done;
    if (report && !stop && !report(static_cast<double>(done) / count)) stop = true;
  }
};

}  // namespace

Film render(const Scene& scene, const Bvh& bvh, const Camera& camera, const RenderOptions& options,
            const HitTesterFactory& make_tester, RenderStats& stats,
            const ProgressFunction& progress_function) {
  assert(options.width > 0 && options.height > 0 && options.threads > 0);
  Stopwatch wall;
  stats = {};
  Film film = empty_film(options);
  const Tiles tiles(film.window);
  RecordCache records(bvh, camera.eye());
  Progress progress(progress_function);

  const auto work = [&] {
    try {
      const auto tester = make_tester();
      Worker worker(scene, bvh, camera, records, *tester, film);
      while (!progress.stop) {
        const int tile = progress.next_tile++;
        if (tile >= tiles.count) break;
        worker.render(tiles[tile]);
        progress.tile_done(tiles.count);
      }
      const std::scoped_lock lock(progress.mutex);
      worker.add_to(stats);
    } catch (...) {
      const std::scoped_lock lock(progress.mutex);
      if (!progress.error) progress.error = std::current_exception();
      progress.stop = true;
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < std::min(options.threads, tiles.count); ++i) threads.emplace_back(work);
    work();
  }
  if (progress.error) std::rethrow_exception(progress.error);
  stats.records = records.made();
  stats.cancelled = progress.done < tiles.count;
  stats.wall_seconds = wall.lap();
  return film;
}

}  // namespace raygate
