// Tile workers: the threads of a process that render tiles into a film.
#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/render_job.h"
#include "host/render/tile_renderer.h"

namespace raygate {

/// Samples of a tile to render: up to number `end`, then `step` more, and so on to `last`.
struct TileWork {
  int number;
  PixelRect rect;
  int end, step, last;
  double seconds;          ///< that one thread took, when it is done
  std::size_t splats = 0;  ///< of a message about it
};

/// What a render's threads do on rank 0 and on others. Where tiles come from and who hears of them
/// is up to a derived class, whose destructor calls join().
class TileWorkers {
 public:
  TileWorkers(const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
              const IntersectorFactory& make_intersector, Film& film,
              std::span<HistoryMask> emitter_histories, RenderStats& stats)
      : job_(job),
        film_(film),
        stats_(stats),
        first_intersector_(std::move(first_intersector)),
        make_intersector_(make_intersector),
        emitter_histories_(emitter_histories) {}
  TileWorkers(const TileWorkers&) = delete;
  TileWorkers& operator=(const TileWorkers&) = delete;
  virtual ~TileWorkers() = default;

 protected:
  // Under the lock:
  virtual std::optional<TileWork> take() = 0;      ///< a tile; none: not now
  [[nodiscard]] virtual bool is_over() const = 0;  ///< no tile will come any more
  virtual void done(const TileWork& work) = 0;     ///< it is in the film
  /// What a part of it has brought to any pixels: that part has just come into the film.
  virtual void add(int tile, std::span<const Splat> splats) = 0;
  /// Not under the lock, now and then in a thread that works.
  virtual void between_batches() {}

  /// Starts up to so many threads; fewer if no more are to be had.
  void start(int count);
  /// A thread's work, until there is none left.
  void work();
  /// Tells the threads to stop.
  void stop();
  void fail(std::exception_ptr error);
  void join() {
    stop();
    threads_.clear();
  }

  const RenderJob& job_;
  std::mutex mutex_;  // of all that follows, but for a tile's pixels while it is rendered
  std::condition_variable changed_;
  Film& film_;
  RenderStats& stats_;
  int gone_ = 0;  // threads that have no work left
  bool stopped_ = false;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;

 private:
  [[nodiscard]] std::unique_ptr<Intersector> take_intersector();
  [[nodiscard]] std::optional<TileWork> next();
  [[nodiscard]] bool render(TileRenderer& renderer, const TileWork& work);

  std::unique_ptr<Intersector> first_intersector_;  // of the thread that begins first
  const IntersectorFactory& make_intersector_;
  std::span<HistoryMask> emitter_histories_;
};

}  // namespace raygate
