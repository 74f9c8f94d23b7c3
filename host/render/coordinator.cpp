#include "host/render/coordinator.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/ranks/ranks.h"
#include "host/render/adaptive_sampling.h"
#include "host/render/remote_workers.h"
#include "host/render/tile_queue.h"
#include "host/render/tile_renderer.h"

namespace raygate {
namespace {

/// The threads that trace, and the one that called, which watches over them: only this one reports
/// and saves, so that nobody waits for a terminal or a disk.
class Coordinator {
 public:
  Coordinator(const RenderJob& job, const Tiles& tiles,
              std::unique_ptr<Intersector> first_intersector,
              const IntersectorFactory& make_intersector, const ProgressFunction& report,
              Film& film, std::span<EmitterEdge> emitter_edges, RenderStats& stats)
      : job_(job),
        tiles_(tiles),
        first_intersector_(std::move(first_intersector)),
        make_intersector_(make_intersector),
        report_(report),
        film_(film),
        emitter_edges_(emitter_edges),
        stats_(stats),
        queue_(tiles.count, tiles.passes(), job.options.begun != nullptr) {
    Ranks* const ranks = job.options.ranks;
    if (ranks == nullptr || ranks->count() == 1) return;
    remote_.emplace(*ranks, tiles, job.options.first_sample, film);
    grace_ = {};
  }

  /// Returns when all is traced, or the caller wants no more.
  void run() {
    look();
    {
      const int wanted = std::min(job_.options.threads, tiles_.count);
      std::jthread server;
      if (remote_) server = std::jthread([this] { serve(); });
      std::vector<std::jthread> threads;
      try {
        while (static_cast<int>(threads.size()) < wanted) threads.emplace_back([this] { work(); });
      } catch (const std::system_error&) {  // no more to be had: these will do
        stats_.missing_threads = wanted - std::max(1, static_cast<int>(threads.size()));
      }
      if (threads.empty()) {
        is_alone_ = true;
        work();
      }
      watch(static_cast<int>(threads.size()));
    }
    if (error_) {
      if (remote_ && job_.options.urgent_snapshot) job_.options.urgent_snapshot(film_);
      std::rethrow_exception(error_);
    }
    stats_.cancelled = !queue_.all_ended();
    if (!stats_.cancelled && report_) report_(1.0);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kLook{50};    // between reports, at most
  static constexpr std::chrono::milliseconds kServe{1};    // between looks for messages
  static constexpr std::chrono::milliseconds kShare{500};  // between looks for what is left

  /// A thread's: until there is nothing left to begin.
  void work() {
    try {
      auto intersector = take_first_intersector();
      if (!intersector) intersector = make_intersector_();
      TileRenderer renderer(job_, *intersector, film_, emitter_edges_);
      const auto keep_going = [this] {
        if (is_alone_) look();
        const std::scoped_lock lock(mutex_);
        return !stopped_;
      };
      while (const auto step = next()) {
        const int end = job_.options.first_sample + tiles_.samples_after(step->pass);
        if (!renderer.trace(tiles_[step->tile], end, keep_going)) break;
        const std::scoped_lock lock(mutex_);
        renderer.write();
        queue_.end(step->tile);
        changed_.notify_all();
      }
      const std::scoped_lock lock(mutex_);
      renderer.add_to(stats_);
    } catch (...) {
      fail(std::current_exception());
    }
    const std::scoped_lock lock(mutex_);
    ++gone_;
    changed_.notify_all();
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

  std::unique_ptr<Intersector> take_first_intersector() {
    const std::scoped_lock lock(mutex_);
    return std::move(first_intersector_);
  }

  /// None when there is none left, or the render is to stop.
  std::optional<TileQueue::Step> next() {
    std::unique_lock lock(mutex_);
    std::optional<TileQueue::Step> step;
    changed_.wait(lock, [&] {
      if (stopped_ || queue_.all_begun()) return true;
      step = queue_.begin();
      return step.has_value();
    });
    return step;
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
        if (job_.options.abandon && !error_ && Clock::now() - stopped_at_ > grace_) {
          const Film film = film_;
          lock.unlock();
          job_.options.abandon(film);
        }
        return;
      }
      const double fraction = fraction_done();
      lock.unlock();
      if (report_ && !report_(fraction)) stop();
      lock.lock();
      if (remote_ && job_.options.is_urgent && job_.options.is_urgent()) {
        const Film film = film_;
        lock.unlock();
        job_.options.urgent_snapshot(film);
        return;
      }
      if (stopped_ || queue_.all_ended() || !job_.options.snapshot) return;
      since_snapshot_ += watch_.lap();
      if (since_snapshot_ < job_.options.snapshot_seconds) return;
      const Film film = film_;
      lock.unlock();
      job_.options.snapshot(film);
      since_snapshot_ = 0.0;
      watch_.lap();
    } catch (...) {
      fail(std::current_exception());
    }
  }

  /// Looks at the film now and then, if that tells.
  double fraction_done() {
    const double wanted = job_.options.error;
    if (wanted == 0.0) return queue_.fraction();
    const Clock::time_point now = Clock::now();
    if (now >= next_share_) {
      share_ = raygate::fraction_done(film_, job_.options.samples, wanted);
      next_share_ = now + kShare;
    }
    return share_;
  }

  void stop() {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    stopped_at_ = Clock::now();
    changed_.notify_all();
  }

  void fail(std::exception_ptr error) {
    {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::move(error);
    }
    stop();
  }

  const RenderJob& job_;
  const Tiles& tiles_;
  std::unique_ptr<Intersector> first_intersector_;  // of the thread that begins first
  const IntersectorFactory& make_intersector_;
  const ProgressFunction& report_;
  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  Film& film_;
  std::span<EmitterEdge> emitter_edges_;
  RenderStats& stats_;
  TileQueue queue_;
  std::optional<RemoteWorkers> remote_;  // none: there is one rank
  bool served_ = false;
  int gone_ = 0;
  bool stopped_ = false;
  Clock::time_point stopped_at_;
  std::exception_ptr error_;
  // Of the watching thread alone.
  std::chrono::milliseconds grace_{500};  // for threads that are to stop
  bool is_alone_ = false;
  Stopwatch watch_;
  double since_snapshot_ = 0.0;
  double share_ = 0.0;
  Clock::time_point next_share_;
};

}  // namespace

void trace_all(const RenderJob& job, const Tiles& tiles,
               std::unique_ptr<Intersector> first_intersector,
               const IntersectorFactory& make_intersector, const ProgressFunction& report,
               Film& film, std::span<EmitterEdge> emitter_edges, RenderStats& stats) {
  Coordinator(job, tiles, std::move(first_intersector), make_intersector, report, film,
              emitter_edges, stats)
      .run();
}

}  // namespace raygate
