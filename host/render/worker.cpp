#include "host/render/worker.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/film/film_region.h"
#include "host/render/tile_message.h"
#include "host/render/tile_renderer.h"

namespace raygate {
namespace {

/// Threads that trace, and the one that called, which talks with rank 0.
class Worker {
 public:
  Worker(const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
         const IntersectorFactory& make_intersector, const ProgressFunction& progress, Film& film,
         std::span<EmitterEdge> emitter_edges, RenderStats& stats)
      : job_(job),
        first_intersector_(std::move(first_intersector)),
        make_intersector_(make_intersector),
        progress_(progress),
        film_(film),
        emitter_edges_(emitter_edges),
        stats_(stats) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { stop(); }

  void run(Ranks& ranks) {
    const double busy = processor_seconds();
    try {
      while (static_cast<int>(threads_.size()) < job_.options.threads) {
        threads_.emplace_back([this] { work(); });
      }
    } catch (const std::system_error&) {
      if (threads_.empty()) throw;  // else these will do
    }
    // One tile more than threads: there is something to do while messages travel.
    ranks.send(0, About::kRoom, bytes_of(static_cast<int>(threads_.size()) + 1));
    while (talk(ranks)) {
    }
    stop();
    if (stats_.cancelled) return;
    threads_.clear();
    stats_.processor_seconds = processor_seconds() - busy;
    ranks.send(0, About::kCounts, bytes_of(stats_));
  }

 private:
  static constexpr std::chrono::milliseconds kLook{1};  // between looks for messages

  /// False when rank 0 has said that all is traced, or the caller wants no more.
  bool talk(Ranks& ranks) {
    while (auto message = ranks.receive()) {
      if (message->about == About::kFinish) return false;
      const auto tile = value_of<TileMessage>(message->bytes);
      if (const auto slice = slice_in(message->bytes); !slice.empty()) {
        set_region(film_, tile.rect, slice);
      }
      const std::scoped_lock lock(mutex_);
      to_do_.push_back(tile);
      changed_.notify_all();
    }
    if (progress_ && !progress_(0.0)) {
      stats_.cancelled = true;
      return false;
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLook, [this] { return error_ || !traced_.empty(); });
    if (error_) std::rethrow_exception(error_);
    for (const TileMessage& tile : std::exchange(traced_, {})) {
      ranks.send(0, About::kTraced, message_of(tile, region_bytes(film_, tile.rect)));
    }
    return true;
  }

  /// A thread's.
  void work() {
    try {
      auto intersector = take_first_intersector();
      if (!intersector) intersector = make_intersector_();
      TileRenderer renderer(job_, *intersector, film_, emitter_edges_);
      while (auto tile = next()) {
        Stopwatch watch;
        if (!trace(renderer, *tile)) break;
        tile->seconds = watch.lap();
        const std::scoped_lock lock(mutex_);
        traced_.push_back(*tile);
        changed_.notify_all();
      }
      const std::scoped_lock lock(mutex_);
      renderer.add_to(stats_);
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
  }

  /// False if it was to stop. Nobody else has this tile's pixels meanwhile.
  bool trace(TileRenderer& renderer, const TileMessage& tile) {
    const auto keep_going = [this] {
      const std::scoped_lock lock(mutex_);
      return !stopped_;
    };
    for (int end = tile.end;; end = std::min(end + tile.step, tile.last)) {
      if (!renderer.trace(tile.rect, end, keep_going)) return false;
      renderer.write();
      if (end == tile.last) return true;
    }
  }

  std::unique_ptr<Intersector> take_first_intersector() {
    const std::scoped_lock lock(mutex_);
    return std::move(first_intersector_);
  }

  std::optional<TileMessage> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || !to_do_.empty(); });
    if (stopped_) return std::nullopt;
    const TileMessage tile = to_do_.front();
    to_do_.pop_front();
    return tile;
  }

  void stop() {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }

  const RenderJob& job_;
  std::mutex mutex_;  // of what follows, but for the film
  std::condition_variable changed_;
  std::unique_ptr<Intersector> first_intersector_;
  const IntersectorFactory& make_intersector_;
  const ProgressFunction& progress_;
  Film& film_;
  std::span<EmitterEdge> emitter_edges_;
  RenderStats& stats_;
  std::deque<TileMessage> to_do_;
  std::vector<TileMessage> traced_;
  bool stopped_ = false;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;  // last: they use the others
};

}  // namespace

void run_worker(Ranks& ranks, const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const ProgressFunction& progress,
                Film& film, std::span<EmitterEdge> emitter_edges, RenderStats& stats) {
  Worker(job, std::move(first_intersector), make_intersector, progress, film, emitter_edges, stats)
      .run(ranks);
}

}  // namespace raygate
