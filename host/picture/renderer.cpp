#include "host/picture/renderer.h"

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "host/light/lights.h"
#include "host/picture/tile_renderer.h"
#include "host/picture/tiles.h"
#include "host/scene/camera.h"
#include "host/stopwatch.h"

namespace raygate {
namespace {

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
  const ExtraChannels& extra = options.channels;
  if (extra.position) film.position.assign(pixels, glm::vec3(0.0f));
  if (extra.albedo) film.albedo.assign(pixels, glm::vec3(0.0f));
  if (extra.object) film.object.assign(pixels, kNoPrimitive);
  if (extra.tests) film.tests.assign(pixels, 0);
  if (extra.doubts) film.doubts.assign(pixels, 0);
  return film;
}

/// What the threads share besides the film: pass after pass, all tiles of each.
class Progress {
 public:
  Progress(const Tiles& tiles, const RenderOptions& options, const ProgressFunction& report)
      : tiles_(tiles), options_(options), report_(report) {}

  /// The next tile and pass; false when there is none, or the render is to stop. A pass begins
  /// when the one before is done: a pixel's samples are added up in their order.
  bool next(int& tile, int& pass) {
    std::unique_lock lock(mutex_);
    const int total = tiles_.count * tiles_.passes();
    if (stopped_ || next_ >= total) return false;
    pass = next_ / tiles_.count;
    tile = next_++ % tiles_.count;
    pass_done_.wait(lock, [&] { return stopped_ || done_ >= pass * tiles_.count; });
    return !stopped_;
  }

  /// Called between waves: false when the render is to stop.
  bool keep_going() {
    const std::scoped_lock lock(mutex_);
    report();
    return !stopped_;
  }

  /// Writes a tile; lets the caller look at the film if it is time.
  void tile_done(TileRenderer& renderer, const Film& film) {
    const std::scoped_lock lock(mutex_);
    renderer.write();
    ++done_;
    report();
    pass_done_.notify_all();
    if (!options_.snapshot || is_complete() || stopped_) return;
    since_snapshot_ += watch_.lap();
    if (since_snapshot_ < options_.snapshot_seconds) return;
    options_.snapshot(film);
    since_snapshot_ = 0.0;
    watch_.lap();
  }

  void failed(std::exception_ptr error) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
    stopped_ = true;
    pass_done_.notify_all();
  }

  void add(const TileRenderer& renderer, RenderStats& stats) {
    const std::scoped_lock lock(mutex_);
    renderer.add_to(stats);
  }

  // When the threads are gone.
  [[nodiscard]] bool is_complete() const { return done_ == tiles_.count * tiles_.passes(); }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void report() {
    const double fraction = static_cast<double>(done_) / (tiles_.count * tiles_.passes());
    if (report_ && !stopped_ && !report_(fraction)) {
      stopped_ = true;
      pass_done_.notify_all();
    }
  }

  const Tiles& tiles_;
  const RenderOptions& options_;
  const ProgressFunction& report_;
  std::mutex mutex_;  // of all that follows, and of the film
  std::condition_variable pass_done_;
  int next_ = 0, done_ = 0;
  bool stopped_ = false;
  std::exception_ptr error_;
  Stopwatch watch_;
  double since_snapshot_ = 0.0;
};

}  // namespace

Film render(const Scene& scene, const Bvh& bvh, const Camera& camera, const RenderOptions& options,
            const FinderFactory& make_finder, RenderStats& stats,
            const ProgressFunction& progress_function) {
  assert(options.width > 0 && options.height > 0 && options.threads > 0 && options.samples > 0);
  Stopwatch wall;
  stats = {};
  Film film = empty_film(options);
  auto first_finder = make_finder();
  const Tiles tiles(film.window, options.samples, first_finder->preferred_batch(),
                    options.threads);
  FilmSums sums;
  if (tiles.passes() > 1) {
    sums.color.assign(film.color.size(), glm::dvec4(0.0));
    sums.albedo.assign(film.albedo.size(), glm::dvec3(0.0));
  }
  const Lights lights(scene, bvh);
  const RenderJob job{scene, bvh, camera, options, lights};
  Progress progress(tiles, options, progress_function);

  const auto work = [&](std::unique_ptr<Finder> finder) {
    try {
      if (!finder) finder = make_finder();
      TileRenderer renderer(job, *finder, film, sums);
      const auto keep_going = [&] { return progress.keep_going(); };
      for (int tile = 0, pass = 0; progress.next(tile, pass);) {
        if (!renderer.trace(tiles[tile], tiles.first_sample(pass), tiles.samples_of(pass),
                            keep_going)) {
          break;
        }
        progress.tile_done(renderer, film);
      }
      progress.add(renderer, stats);
    } catch (...) {
      progress.failed(std::current_exception());
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < std::min(options.threads, tiles.count); ++i) threads.emplace_back(work, nullptr);
    work(std::move(first_finder));
  }
  progress.rethrow();
  if (stats.find.common_records != 0) {
    stats.skipped.records =
        bvh.slot_count() * (1 + lights.points().size()) - stats.find.common_records;
  }
  const std::uint64_t every_test = stats.rays * bvh.slot_count();
  stats.skipped.culled_tests = every_test - std::min(every_test, stats.find.hit.tests);
  stats.cancelled = !progress.is_complete();
  stats.wall_seconds = wall.lap();
  return film;
}

}  // namespace raygate
