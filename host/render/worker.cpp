// What a rank other than 0 does in a render.
#include <chrono>
#include <deque>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/film/film.h"
#include "host/render/coordinator.h"
#include "host/render/remote_workers.h"
#include "host/render/tile_workers.h"

namespace raygate {
namespace {

/// Threads that render, and the one that called, which talks with rank 0.
class Worker : public TileWorkers {
 public:
  using TileWorkers::TileWorkers;
  ~Worker() override { join(); }

  void run(Ranks& ranks, const RenderMonitor& monitor) {
    const double busy = processor_seconds();
    start(job_.options.threads);
    if (threads_.empty()) throw std::runtime_error("no thread could be started");
    // One tile more than threads: there is something to do while messages travel.
    ranks.send(0, About::kRoom, bytes_of(static_cast<int>(threads_.size()) + 1));
    while (talk(ranks, monitor)) {
    }
    stop();
    if (stats_.cancelled) return;
    threads_.clear();
    stats_.processor_seconds = processor_seconds() - busy;
    ranks.send(0, About::kCounts, bytes_of(stats_));
  }

 private:
  static constexpr std::chrono::milliseconds kLook{1};  // between looks for messages

  std::optional<TileWork> take() override {
    if (to_do_.empty()) return std::nullopt;
    const TileWork work = to_do_.front();
    to_do_.pop_front();
    return work;
  }
  [[nodiscard]] bool is_over() const override { return false; }
  void done(const TileWork& work) override { traced_.push_back(work); }
  void add(int tile, std::span<const Splat> splats) override {
    std::vector<Splat>& all = splats_[tile];
    all.insert(all.end(), splats.begin(), splats.end());
  }

  /// False when rank 0 has said that all is rendered, or the caller wants no more.
  bool talk(Ranks& ranks, const RenderMonitor& monitor) {
    while (auto message = ranks.receive()) {
      if (message->about == About::kFinish) return false;
      const auto work = value_of<TileWork>(message->bytes);
      if (const auto region = region_in(message->bytes); !region.empty()) {
        set_region(film_, work.rect, region);
      }
      const std::scoped_lock lock(mutex_);
      to_do_.push_back(work);
      changed_.notify_all();
    }
    if (monitor.progress && !monitor.progress(0.0)) {
      stats_.cancelled = true;
      return false;
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLook, [this] { return error_ || !traced_.empty(); });
    if (error_) std::rethrow_exception(error_);
    for (const TileWork& work : std::exchange(traced_, {})) {
      ranks.send(0, About::kTraced,
                 message_of(work, region_bytes(film_, work.rect),
                            std::exchange(splats_[work.number], {})));
    }
    return true;
  }

  std::deque<TileWork> to_do_;
  std::vector<TileWork> traced_;
  std::map<int, std::vector<Splat>> splats_;  // of tiles that rank 0 has not yet
};

}  // namespace

void run_worker(Ranks& ranks, const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats) {
  Worker(job, std::move(first_intersector), make_intersector, film, emitter_histories, stats)
      .run(ranks, monitor);
}

}  // namespace raygate
