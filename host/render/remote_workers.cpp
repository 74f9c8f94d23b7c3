#include "host/render/remote_workers.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/base/stopwatch.h"
#include "host/film/film.h"

namespace raygate {
namespace {

// Smallest limit on the seconds of work per message, which are lost if a rank dies.
constexpr double kSeconds = 1.0;
// Bytes per second sent to rank 0, which can receive several times as many.
constexpr double kRate = 250e6;

double thread_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::vector<Splat> splats_in(const std::string& message) {
  const std::size_t room = message.size() - sizeof(TileWork);
  const auto count = value_of<TileWork>(message).splats;
  if (count > room / sizeof(Splat)) throw_short_message(room, count * sizeof(Splat));
  std::vector<Splat> splats(count);
  std::memcpy(static_cast<void*>(splats.data()), message.data() + sizeof(TileWork),
              count * sizeof(Splat));
  return splats;
}

RemoteWorkers::RemoteWorkers(Ranks& ranks, const Tiles& tiles, int first_sample, Film& film,
                             SplatLayer& splats)
    : ranks_(ranks),
      tiles_(tiles),
      first_sample_(first_sample),
      film_(film),
      splats_(splats),
      room_(static_cast<std::size_t>(ranks.count()), 0) {}

bool RemoteWorkers::serve(TileQueue& queue) {
  const double start = thread_seconds();
  bool came_back = false, did_something = false;
  while (const auto message = ranks_.receive()) {
    take(*message, queue);
    came_back = came_back || message->about == About::kTraced;
    did_something = true;
  }
  for (bool gave = true; gave;) {  // one tile for each rank in turn
    gave = false;
    for (int rank = 1; rank < ranks_.count(); ++rank) {
      int& room = room_[static_cast<std::size_t>(rank)];
      if (room == 0) continue;
      const auto step = queue.begin(rank, most_passes(queue));
      if (!step) break;
      give(rank, *step);
      --room;
      gave = did_something = true;
    }
  }
  if (did_something) serving_ += thread_seconds() - start;
  return came_back;
}

void RemoteWorkers::take(const Message& message, TileQueue& queue) {
  int& room = room_[static_cast<std::size_t>(message.from)];
  if (message.about == About::kRoom) {
    room = value_of<int>(message.bytes);
    most_room_ += room;
  } else if (message.about == About::kTraced) {
    const auto tile = value_of<TileWork>(message.bytes);
    if (tile.number < 0 || tile.number >= tiles_.count || tile.step < 1) {
      throw InputError("rank " + std::to_string(message.from) + ": found samples of tile " +
                       std::to_string(tile.number) + ", expected one of " +
                       std::to_string(tiles_.count));
    }
    const std::vector<Splat> splats = splats_in(message.bytes);
    set_region(film_, tile.rect, region_in(message.bytes));
    splats_.add(splats);
    queue.end(tile.number);
    seconds_ += tile.seconds;
    passes_ += (tile.last - tile.end) / tile.step + 1;
    ++tiles_back_;
    bytes_back_ += message.bytes.size();
    ++room;
  }
}

/// Returns the maximum passes per message. It decreases towards the end, so that all ranks end
/// together. The work takes at most kSeconds, or longer if rank 0 would be overloaded.
int RemoteWorkers::most_passes(const TileQueue& queue) const {
  const double share = static_cast<double>(queue.left()) / (4.0 * most_room_);
  if (passes_ == 0) return 1;
  const double slice = static_cast<double>(bytes_back_) / static_cast<double>(tiles_back_);
  const double seconds = std::max(kSeconds, most_room_ * slice / kRate);
  const double in_time = seconds * static_cast<double>(passes_) / seconds_;
  return static_cast<int>(std::clamp(std::min(share, in_time), 1.0, 1e6));
}

void RemoteWorkers::give(int rank, const TileQueue::Step& step) {
  const auto samples = [&](int pass) { return first_sample_ + tiles_.samples_after(pass); };
  const TileWork tile{.number = step.tile,
                      .rect = tiles_[step.tile],
                      .end = samples(step.pass),
                      .step = tiles_.samples_per_pass,
                      .last = samples(step.end_pass - 1),
                      .seconds = 0.0};
  ranks_.send(rank, About::kTile,
              message_of(tile, step.moves ? region_bytes(film_, tile.rect) : std::string()));
}

bool RemoteWorkers::finish(RenderStats& stats) {
  for (int rank = 1; !told_ && rank < ranks_.count(); ++rank) ranks_.send(rank, About::kFinish, {});
  told_ = true;
  while (const auto message = ranks_.receive()) {
    if (message->about != About::kCounts) continue;  // from a rank that has just joined
    stats.add(value_of<RenderStats>(message->bytes));
    ++heard_;
  }
  if (heard_ < ranks_.count() - 1) return false;
  stats.gather_seconds = serving_;
  stats.gathered_tiles = tiles_back_;
  stats.gathered_bytes = bytes_back_;
  return true;
}

namespace {

/// The rendering threads of a rank, and the calling thread, which communicates with rank 0.
class Worker : public TileWorkers {
 public:
  using TileWorkers::TileWorkers;
  ~Worker() override { join(); }

  void run(Ranks& ranks, const RenderMonitor& monitor) {
    const double busy = processor_seconds();
    start(context_.settings.threads);
    if (threads_.empty()) throw std::runtime_error("no thread could be started");
    // One tile more than threads hides the latency of messages.
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
  static constexpr std::chrono::milliseconds kLook{1};  // polling interval

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

  /// Processes messages. Returns false when rank 0 has ended the render, or the monitor stops it.
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
  std::map<int, std::vector<Splat>> splats_;  // splats of tiles that were not sent yet
};

}  // namespace

void run_worker(Ranks& ranks, const RenderContext& context,
                std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats) {
  Worker(context, std::move(first_intersector), make_intersector, film, emitter_histories, stats)
      .run(ranks, monitor);
}

}  // namespace raygate
