#include "host/render/coordinator.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "host/base/stopwatch.h"
#include "host/ranks/ranks.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/remote_workers.h"
#include "host/render/tile_workers.h"
#include "host/render/tiles.h"

namespace raygate {
namespace {

/// The threads and ranks that take tiles from one queue, and the thread that called, which watches
/// over them: only this one reports and saves, so that nobody waits for a terminal or a disk.
class Coordinator : public TileWorkers {
 public:
  Coordinator(const RenderJob& job, const Tiles& tiles,
              std::unique_ptr<Intersector> first_intersector,
              const IntersectorFactory& make_intersector, const RenderMonitor& monitor, Film& film,
              std::span<HistoryMask> emitter_histories, RenderStats& stats)
      : TileWorkers(job, std::move(first_intersector), make_intersector, film, emitter_histories,
                    stats),
        tiles_(tiles),
        monitor_(monitor),
        queue_(tiles.count, tiles.passes(), job.options.unfinished != nullptr) {
    if (job.light_paths != nullptr) splats_ = SplatLayer(film.window, job.options.filter);
    Ranks* const ranks = job.options.ranks;
    if (ranks == nullptr || ranks->count() == 1) return;
    remote_.emplace(*ranks, tiles, job.options.first_sample, film, splats_);
    grace_ = {};
  }
  ~Coordinator() override { join(); }

  /// Returns when all is rendered, or the caller wants no more.
  void run() {
    look();
    {
      const int wanted = std::min(job_.options.threads, tiles_.count);
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
  static constexpr std::chrono::milliseconds kLook{50};    // between reports, at most
  static constexpr std::chrono::milliseconds kServe{1};    // between looks for messages
  static constexpr std::chrono::milliseconds kShare{500};  // between looks for what is left

  std::optional<TileWork> take() override {
    const auto step = queue_.begin();
    if (!step) return std::nullopt;
    const int end = job_.options.first_sample + tiles_.samples_after(step->pass);
    return TileWork{step->tile, tiles_[step->tile], end, 0, end, 0.0};
  }
  [[nodiscard]] bool is_over() const override { return queue_.all_begun(); }
  void done(const TileWork& work) override { queue_.end(work.number); }
  void add(int /*tile*/, std::span<const Splat> splats) override { splats_.add(splats); }
  void between_batches() override {
    if (is_alone_) look();
  }

  /// The other ranks', on a thread of its own: a save or a terminal keeps none of them waiting.
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

  /// Until so many threads are gone, and all other ranks have said their last word.
  void watch(int threads) {
    std::unique_lock lock(mutex_);
    while (gone_ < threads || (remote_ && !served_)) {
      changed_.wait_for(lock, kLook);
      lock.unlock();
      look();
      lock.lock();
    }
  }

  /// Reports, and saves if it is time.
  void look() {
    try {
      std::unique_lock lock(mutex_);
      if (stopped_) {
        if (!stopped_at_) stopped_at_ = Clock::now();
        if (monitor_.abandon && !error_ && Clock::now() - *stopped_at_ > grace_) {
          splats_.add_to(film_);
          monitor_.abandon(film_);  // under the lock: nobody changes it any more
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

  /// Gives a copy of the film away, while the threads go on.
  void show(std::unique_lock<std::mutex>& lock, const std::function<void(const Film*)>& take) {
    lock.unlock();
    std::optional<Film> film;
    try {
      film = copy_of_film();
    } catch (const std::bad_alloc&) {  // NOLINT(bugprone-empty-catch): the render needs none
    }
    take(film ? &*film : nullptr);
  }

  /// Tile by tile: a thread waits for the copy of one at most. With light paths, all at once: what
  /// these have brought belongs to the samples that the film has.
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
      if (job_.light_paths != nullptr) continue;
      lock.unlock();
      lock.lock();
    }
    splats_.add_to(copy);
    return copy;
  }

  /// Looks at the film now and then, if that tells.
  double share_done() {
    const double wanted = job_.options.error;
    if (wanted == 0.0) return queue_.fraction();
    const Clock::time_point now = Clock::now();
    if (now >= next_share_) {
      share_ = fraction_done(film_, job_.options.samples, wanted);
      next_share_ = now + kShare;
    }
    return share_;
  }

  const Tiles& tiles_;
  const RenderMonitor& monitor_;
  TileQueue queue_;
  SplatLayer splats_;
  std::optional<RemoteWorkers> remote_;  // none: there is one rank
  bool served_ = false;
  // Of the watching thread alone.
  std::chrono::milliseconds grace_{500};  // for threads that are to stop
  std::optional<Clock::time_point> stopped_at_;
  bool is_alone_ = false;
  Stopwatch watch_;
  double since_snapshot_ = 0.0;
  double share_ = 0.0;
  Clock::time_point next_share_;
};

}  // namespace

void run_coordinator(const RenderJob& job, const Tiles& tiles,
                     std::unique_ptr<Intersector> first_intersector,
                     const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                     Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats) {
  Coordinator(job, tiles, std::move(first_intersector), make_intersector, monitor, film,
              emitter_histories, stats)
      .run();
}

}  // namespace raygate
