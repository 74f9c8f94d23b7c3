#include "host/render/renderer.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/measure.h"
#include "host/light/light_paths.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/render_context.h"
#include "host/render/tile_renderer.h"
#include "host/render/tiles.h"

namespace raygate {
namespace {

/// The threads of a render. They take tiles from one queue. Only the calling thread reports
/// progress and makes snapshots, so no worker waits for a terminal or a disk.
class RenderThreads {
 public:
  RenderThreads(const RenderContext& context, const Tiles& tiles,
                const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats)
      : context_(context),
        tiles_(tiles),
        make_intersector_(make_intersector),
        monitor_(monitor),
        emitter_histories_(emitter_histories),
        film_(film),
        stats_(stats),
        queue_(tiles.count, tiles.passes()) {
    if (context.light_paths != nullptr) splats_ = SplatLayer(film.window, context.settings.filter);
  }
  ~RenderThreads() {
    stop();
    threads_.clear();
  }

  /// Returns when the image is complete or the monitor has stopped the render. The first thread
  /// uses `intersector`, the others make their own.
  void run(std::unique_ptr<Intersector> intersector) {
    report();
    const int wanted = std::min(context_.settings.threads, tiles_.count);
    try {
      for (int i = 0; i < wanted; ++i) {
        threads_.emplace_back(&RenderThreads::work, this, std::exchange(intersector, nullptr));
      }
    } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): fewer threads will do
    }
    const auto threads = static_cast<int>(threads_.size());
    stats_.missing_threads = wanted - std::max(1, threads);
    if (threads == 0) {
      is_alone_ = true;
      work(nullptr);
    }
    for (std::unique_lock lock(mutex_); gone_ < threads;) {
      changed_.wait_for(lock, kReport);
      lock.unlock();
      report();
      lock.lock();
    }
    threads_.clear();
    splats_.add_to(film_);
    if (error_) std::rethrow_exception(error_);
    stats_.cancelled = !queue_.all_ended();
    if (!stats_.cancelled && monitor_.progress) monitor_.progress(1.0);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kReport{50};  // maximum interval between reports
  static constexpr std::chrono::milliseconds kGrace{500};  // for threads to stop

  /// Renders tiles until there are no more. Runs on each thread.
  void work(std::unique_ptr<Intersector> intersector) {
    try {
      if (!intersector) intersector = make_intersector_();
      TileRenderer renderer(context_, *intersector, film_, emitter_histories_);
      while (const auto step = next()) {
        if (!render(renderer, *step)) break;
      }
      const std::scoped_lock lock(mutex_);
      renderer.add_to(stats_);
    } catch (...) {
      stop(std::current_exception());
    }
    const std::scoped_lock lock(mutex_);
    ++gone_;
    changed_.notify_all();
  }

  /// Returns the next step, or nullopt if there is none left or the threads must stop.
  [[nodiscard]] std::optional<TileQueue::Step> next() {
    std::unique_lock lock(mutex_);
    std::optional<TileQueue::Step> step;
    changed_.wait(lock, [&] { return stopped_ || queue_.all_begun() || (step = queue_.begin()); });
    return step;
  }

  /// Renders a pass over a tile. Returns false if the render was stopped. No other thread accesses
  /// the tile's pixels meanwhile.
  [[nodiscard]] bool render(TileRenderer& renderer, const TileQueue::Step& step) {
    const auto keep_going = [this] {
      if (is_alone_) report();
      const std::scoped_lock lock(mutex_);
      return !stopped_;
    };
    const int end = context_.settings.first_sample + tiles_.samples_after(step.pass);
    if (!renderer.trace(tiles_[step.tile], end, keep_going)) return false;
    const std::scoped_lock lock(mutex_);
    renderer.write();
    splats_.add(renderer.splats());
    queue_.end(step);
    changed_.notify_all();
    return true;
  }

  /// Tells the threads to stop. Keeps the first error.
  void stop(const std::exception_ptr& error = nullptr) {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = error;
    stopped_ = true;
    changed_.notify_all();
  }

  /// Reports progress, and makes a snapshot when it is due.
  void report() {
    try {
      std::unique_lock lock(mutex_);
      if (stopped_) {
        if (!stopped_at_) stopped_at_ = Clock::now();
        if (monitor_.abandon && !error_ && Clock::now() - *stopped_at_ > kGrace) {
          splats_.add_to(film_);
          monitor_.abandon(film_);  // under the lock: the film must not change
        }
        return;
      }
      const double fraction = queue_.fraction();
      lock.unlock();
      if (monitor_.progress && !monitor_.progress(fraction)) {
        stop();
        stopped_at_ = Clock::now();
      }
      lock.lock();
      if (stopped_ || queue_.all_ended() || !monitor_.snapshot) return;
      since_snapshot_ += watch_.lap();
      if (since_snapshot_ < monitor_.snapshot_seconds) return;
      lock.unlock();
      save();
      since_snapshot_ = 0.0;
      watch_.lap();
    } catch (...) {
      stop(std::current_exception());
    }
  }

  /// Passes a copy of the film to the monitor, while the threads continue.
  void save() {
    std::optional<Film> film;
    try {
      film = copy_of_film();
    } catch (const std::bad_alloc&) {  // NOLINT(bugprone-empty-catch): snapshots are optional
    }
    monitor_.snapshot(film ? &*film : nullptr);
  }

  /// Returns a copy of the film. It is made tile by tile, so a thread waits for at most one tile.
  /// With light paths, all tiles are copied at once: splats must match the samples.
  Film copy_of_film() {
    Film copy;
    copy.width = film_.width;
    copy.height = film_.height;
    copy.window = film_.window;
    copy.keeps_sums = film_.keeps_sums;
    for_each_field([](const FilmField&, const auto& from, auto& to) { to.resize(from.size()); },
                   film_, copy);
    std::unique_lock lock(mutex_);
    for (int i = 0; i < tiles_.count; ++i) {
      copy_region(film_, tiles_[i], copy);
      if (context_.light_paths != nullptr) continue;
      lock.unlock();
      lock.lock();
    }
    splats_.add_to(copy);
    return copy;
  }

  const RenderContext& context_;
  const Tiles& tiles_;
  const IntersectorFactory& make_intersector_;
  const RenderMonitor& monitor_;
  std::span<HistoryMask> emitter_histories_;
  std::mutex mutex_;  // guards the members below, except pixels of a tile that is being rendered
  std::condition_variable changed_;
  Film& film_;
  RenderStats& stats_;
  TileQueue queue_;
  SplatLayer splats_;
  int gone_ = 0;  // number of threads that have ended
  bool stopped_ = false;
  std::exception_ptr error_;
  // Members that only the calling thread uses.
  std::optional<Clock::time_point> stopped_at_;
  bool is_alone_ = false;
  Stopwatch watch_;
  double since_snapshot_ = 0.0;
  std::vector<std::jthread> threads_;
};

/// Returns whether light paths are requested and possible.
bool wants_light_paths(const RenderJob& job) {
  const RenderSettings& settings = job.settings;
  return settings.caustics && settings.integrator == IntegratorKind::kPath &&
         settings.samples > 1 && settings.error == 0.0 && !job.lights &&
         job.camera.projection() == Projection::kPerspective;
}

}  // namespace

Film render(const RenderJob& job, const IntersectorFactory& make_intersector, RenderStats& stats,
            const RenderMonitor& monitor) {
  const auto& [prepared, camera, settings, camera_lights, unfinished] = job;
  assert(settings.width > 0 && settings.height > 0 && settings.threads > 0 && settings.samples > 0);
  Stopwatch wall;
  const double busy = processor_seconds();
  stats = {};
  const Bvh& bvh = prepared.bvh;
  const bool is_crop = settings.window.width() > 0 && settings.window.height() > 0;
  const PixelRect frame{0, 0, settings.width, settings.height};
  Film film = make_film(settings.width, settings.height, is_crop ? settings.window : frame,
                        settings.channels);
  auto first_intersector = make_intersector();
  const int end = settings.end_sample > 0 ? settings.end_sample : settings.samples;
  const Tiles tiles(film.window, end - settings.first_sample, first_intersector->traits().batch,
                    settings.threads);
  const bool is_path = settings.integrator == IntegratorKind::kPath;
  const auto sampling = is_path ? Lights::Sampling::kOne : Lights::Sampling::kAll;
  std::optional<Lights> own_lights;
  if (camera_lights) own_lights.emplace(prepared.scene, bvh, sampling, camera_lights);
  const Lights& lights = own_lights ? *own_lights : prepared.lights(sampling);
  std::optional<LightPaths> light_paths;
  if (wants_light_paths(job)) {
    // The part of the frame in which splats affect pixels of the film's window.
    const glm::dvec2 size(film.width, film.height);
    const double margin = filter_radius(settings.filter) + 1.0;
    const glm::dvec2 low(film.window.x0, film.window.y0), high(film.window.x1, film.window.y1);
    const FrameView view{camera, film.width, film.height, (low - margin) / size,
                         (high + margin) / size};
    light_paths.emplace(prepared, lights, view);
    if (!light_paths->exist()) light_paths.reset();
  }
  if (unfinished != nullptr) {
    film = *unfinished;
    assert(film.sums.samples.size() == film.color.size());
  } else if (tiles.passes() > 1 || film.keeps_sums || settings.error > 0.0 || light_paths) {
    add_sums(film, settings.error > 0.0);
  }
  film.keeps_sums = settings.channels.sums || unfinished != nullptr;
  // With a single sample through the pixel's centre, emitters have no edges to smooth. Emitters
  // seen through a lens are not supersampled.
  std::vector<HistoryMask> emitter_histories;
  if (settings.samples > 1 && camera.aperture() == 0.0 && !lights.areas().empty()) {
    emitter_histories.assign(film.color.size(), kUnknownHistories);
  }
  const RenderContext context{prepared, camera, settings, lights,
                              light_paths ? &*light_paths : nullptr};
  RenderThreads(context, tiles, make_intersector, monitor, film, emitter_histories, stats)
      .run(std::move(first_intersector));
  if (!stats.cancelled) film.keeps_sums = settings.channels.sums;
  if (settings.error > 0.0) {
    for (std::size_t i = 0; i < film.color.size(); ++i) {
      const auto samples = static_cast<int>(film.sums.samples[i]);
      stats.spare_samples += static_cast<std::uint64_t>(settings.samples - samples);
      if (!has_converged(film.sums.error[i], samples, settings.error)) ++stats.unfinished_pixels;
    }
  }
  stats.wall_seconds = wall.lap();
  stats.processor_seconds += processor_seconds() - busy;
  return film;
}

}  // namespace raygate
