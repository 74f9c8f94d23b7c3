#include "host/render/renderer.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/light/light_paths.h"
#include "host/light/lights.h"
#include "host/ranks/ranks.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/remote_workers.h"
#include "host/render/splat_layer.h"
#include "host/render/tile_workers.h"
#include "host/render/tiles.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

int count_of(const Ranks* ranks) { return ranks == nullptr ? 1 : ranks->count(); }

/// Renders an image on rank 0: threads and other ranks take tiles from one queue. The calling
/// thread reports progress and saves, so that no worker waits for a terminal or a disk.
class Coordinator : public TileWorkers {
 public:
  Coordinator(const RenderContext& context, const RenderJob& job, const Tiles& tiles,
              std::unique_ptr<Intersector> first_intersector,
              const IntersectorFactory& make_intersector, const RenderMonitor& monitor, Film& film,
              std::span<HistoryMask> emitter_histories, RenderStats& stats)
      : TileWorkers(context, std::move(first_intersector), make_intersector, film,
                    emitter_histories, stats),
        tiles_(tiles),
        monitor_(monitor),
        queue_(tiles.count, tiles.passes(), job.unfinished != nullptr) {
    if (context.light_paths != nullptr) splats_ = SplatLayer(film.window, context.settings.filter);
    if (count_of(job.ranks) == 1) return;
    remote_.emplace(*job.ranks, tiles, context.settings.first_sample, film, splats_);
    grace_ = {};
  }
  ~Coordinator() override { join(); }

  /// Returns when the image is complete or the monitor has stopped the render.
  void run() {
    look();
    {
      const int wanted = std::min(context_.settings.threads, tiles_.count);
      std::jthread server;
      if (remote_) server = std::jthread([this] { serve(); });
      start(wanted);
      const auto threads = static_cast<int>(threads_.size());
      stats_.missing_threads = wanted - std::max(1, threads);
      if (threads == 0) {
        is_alone_ = true;
        work();
      }
      watch(threads);
    }
    threads_.clear();
    splats_.add_to(film_);
    if (error_) {
      if (remote_ && monitor_.urgent_snapshot) monitor_.urgent_snapshot(&film_);
      std::rethrow_exception(error_);
    }
    stats_.cancelled = !queue_.all_ended();
    if (!stats_.cancelled && monitor_.progress) monitor_.progress(1.0);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLook{50};  // maximum interval between reports
  static constexpr std::chrono::milliseconds kServe{1};  // polling interval for messages
  // Interval between estimates of the remaining work.
  static constexpr std::chrono::milliseconds kShare{500};

  std::optional<TileWork> take() override {
    const auto step = queue_.begin();
    if (!step) return std::nullopt;
    const int end = context_.settings.first_sample + tiles_.samples_after(step->pass);
    return TileWork{step->tile, tiles_[step->tile], end, 0, end, 0.0};
  }
  [[nodiscard]] bool is_over() const override { return queue_.all_begun(); }
  void done(const TileWork& work) override { queue_.end(work.number); }
  void add(int /*tile*/, std::span<const Splat> splats) override { splats_.add(splats); }
  void between_batches() override {
    if (is_alone_) look();
  }

  /// Serves the other ranks on a thread of its own, so that saving and reporting do not delay them.
  void serve() {
    try {
      std::unique_lock lock(mutex_);
      while (!stopped_ && !(queue_.all_ended() && remote_->finish(stats_))) {
        if (!queue_.all_ended() && remote_->serve(queue_)) changed_.notify_all();
        changed_.wait_for(lock, kServe);
      }
    } catch (...) {
      fail(std::current_exception());
    }
    const std::scoped_lock lock(mutex_);
    served_ = true;
    changed_.notify_all();
  }

  /// Waits until `threads` threads have ended, and all other ranks have sent their statistics.
  void watch(int threads) {
    std::unique_lock lock(mutex_);
    while (gone_ < threads || (remote_ && !served_)) {
      changed_.wait_for(lock, kLook);
      lock.unlock();
      look();
      lock.lock();
    }
  }

  /// Reports progress, and saves when it is time.
  void look() {
    try {
      std::unique_lock lock(mutex_);
      if (stopped_) {
        if (!stopped_at_) stopped_at_ = Clock::now();
        if (monitor_.abandon && !error_ && Clock::now() - *stopped_at_ > grace_) {
          splats_.add_to(film_);
          monitor_.abandon(film_);  // under the lock, so that the film does not change
        }
        return;
      }
      const double fraction = share_done();
      lock.unlock();
      if (monitor_.progress && !monitor_.progress(fraction)) {
        stop();
        stopped_at_ = Clock::now();
      }
      lock.lock();
      if (remote_ && monitor_.is_urgent && monitor_.is_urgent()) {
        show(lock, monitor_.urgent_snapshot);
        return;
      }
      if (stopped_ || queue_.all_ended() || !monitor_.snapshot) return;
      since_snapshot_ += watch_.lap();
      if (since_snapshot_ < monitor_.snapshot_seconds) return;
      show(lock, monitor_.snapshot);
      since_snapshot_ = 0.0;
      watch_.lap();
    } catch (...) {
      fail(std::current_exception());
    }
  }

  /// Passes a copy of the film to `take`, while the threads continue.
  void show(std::unique_lock<std::mutex>& lock, const std::function<void(const Film*)>& take) {
    lock.unlock();
    std::optional<Film> film;
    try {
      film = copy_of_film();
    } catch (const std::bad_alloc&) {  // NOLINT(bugprone-empty-catch): the render needs none
    }
    take(film ? &*film : nullptr);
  }

  /// Returns a copy of the film, made tile by tile, so that a thread waits for at most one tile.
  /// With light paths, copies all at once, as splats belong to the film's current samples.
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
      set_region(copy, tiles_[i], region_bytes(film_, tiles_[i]));
      if (context_.light_paths != nullptr) continue;
      lock.unlock();
      lock.lock();
    }
    splats_.add_to(copy);
    return copy;
  }

  /// Returns the completed fraction. With an error limit, estimates it periodically from the film.
  double share_done() {
    const double wanted = context_.settings.error;
    if (wanted == 0.0) return queue_.fraction();
    const Clock::time_point now = Clock::now();
    if (now >= next_share_) {
      share_ = fraction_done(film_, context_.settings.samples, wanted);
      next_share_ = now + kShare;
    }
    return share_;
  }

  const Tiles& tiles_;
  const RenderMonitor& monitor_;
  TileQueue queue_;
  SplatLayer splats_;
  std::optional<RemoteWorkers> remote_;  // none if there is one rank
  bool served_ = false;
  // Members of the watching thread only.
  std::chrono::milliseconds grace_{500};  // for threads to stop
  std::optional<Clock::time_point> stopped_at_;
  bool is_alone_ = false;
  Stopwatch watch_;
  double since_snapshot_ = 0.0;
  double share_ = 0.0;
  Clock::time_point next_share_;
};

Film empty_film(const RenderSettings& settings) {
  const PixelRect frame{0, 0, settings.width, settings.height};
  const bool is_crop = settings.window.width() > 0 && settings.window.height() > 0;
  const PixelRect& window = is_crop ? settings.window : frame;
  assert(window.x0 >= 0 && window.x1 <= settings.width);
  assert(window.y0 >= 0 && window.y1 <= settings.height);
  return make_film(settings.width, settings.height, window, settings.channels);
}

/// Returns whether light paths are requested and possible.
bool wants_light_paths(const RenderJob& job) {
  const RenderSettings& settings = job.settings;
  return settings.caustics != Caustics::kOff && settings.integrator == IntegratorKind::kPath &&
         settings.samples > 1 && settings.error == 0.0 && !job.lights &&
         job.camera.projection() == Projection::kPerspective;
}

/// Returns the part of the frame that light paths must hit to reach the film's window.
FrameView frame_view(const RenderJob& job, const Film& film) {
  const glm::dvec2 size(film.width, film.height);
  const double margin = filter_radius(job.settings.filter) + 1.0;
  const PixelRect& window = film.window;
  return {job.camera, film.width, film.height, (glm::dvec2(window.x0, window.y0) - margin) / size,
          (glm::dvec2(window.x1, window.y1) + margin) / size};
}

}  // namespace

Film render(const RenderJob& job, const IntersectorFactory& make_intersector, RenderStats& stats,
            const RenderMonitor& monitor) {
  const auto& [prepared, camera, settings, camera_lights, unfinished, ranks] = job;
  assert(settings.width > 0 && settings.height > 0 && settings.threads > 0 && settings.samples > 0);
  Stopwatch wall;
  const double busy = processor_seconds();
  stats = {};
  const Bvh& bvh = prepared.bvh;
  const int rank_count = count_of(ranks);
  const bool is_shared = rank_count > 1;
  Film film = empty_film(settings);
  auto first_intersector = make_intersector();
  const int end = settings.end_sample > 0 ? settings.end_sample : settings.samples;
  const Tiles tiles(film.window, end - settings.first_sample, first_intersector->preferred_batch(),
                    settings.threads, rank_count, settings.error > 0.0);
  const bool is_path = settings.integrator == IntegratorKind::kPath;
  const auto sampling = is_path ? Lights::Sampling::kOne : Lights::Sampling::kAll;
  std::optional<Lights> own_lights;
  if (camera_lights) own_lights.emplace(prepared.scene, bvh, sampling, camera_lights);
  const Lights& lights = own_lights ? *own_lights : prepared.lights(sampling);
  std::optional<LightPaths> light_paths;
  if (wants_light_paths(job)) {
    light_paths.emplace(prepared, lights, frame_view(job, film));
    if (!light_paths->exist()) light_paths.reset();
  }
  if (unfinished != nullptr) {
    film = *unfinished;
    assert(film.sums.samples.size() == film.color.size());
  } else if (tiles.passes() > 1 || film.keeps_sums || settings.error > 0.0 || is_shared ||
             light_paths) {
    add_sums(film, settings.error > 0.0);
  }
  film.keeps_sums = settings.channels.sums || is_shared || unfinished != nullptr;
  // With a single sample through the pixel's centre, emitters have no edges to smooth. Emitters
  // seen through a lens are not supersampled.
  std::vector<HistoryMask> emitter_histories;
  if (settings.samples > 1 && camera.aperture() == 0.0 && !lights.areas().empty()) {
    emitter_histories.assign(film.color.size(), kUnknownHistories);
  }
  const RenderContext context{prepared, camera, settings, lights,
                              light_paths ? &*light_paths : nullptr};
  if (is_shared && ranks->index() != 0) {
    run_worker(*ranks, context, std::move(first_intersector), make_intersector, monitor, film,
               emitter_histories, stats);
    return film;
  }
  Coordinator(context, job, tiles, std::move(first_intersector), make_intersector, monitor, film,
              emitter_histories, stats)
      .run();
  if (!stats.cancelled) film.keeps_sums = settings.channels.sums;
  if (stats.intersect.common_records != 0) {
    const std::size_t origins = (camera.has_common_origin() ? 1 : 0) + lights.points().size();
    const std::uint64_t every_record = bvh.primitive_count() * origins * std::uint64_t(rank_count);
    stats.skipped.records = every_record - stats.intersect.common_records;
  }
  const std::uint64_t every_test = stats.rays * bvh.triangle_count();
  stats.skipped.culled_tests = every_test - std::min(every_test, stats.intersect.hit.tests);
  if (settings.error > 0.0) {
    for (const std::uint32_t samples : film.sums.samples) {
      stats.spare_samples += static_cast<std::uint32_t>(settings.samples) - samples;
    }
  }
  stats.wall_seconds = wall.lap();
  stats.processor_seconds += processor_seconds() - busy;
  return film;
}

}  // namespace raygate
