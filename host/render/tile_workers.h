// Tile workers: threads of a process that render tiles into a film.
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
#include "host/render/render_context.h"
#include "host/render/tile_renderer.h"

namespace raygate {

/// Samples of a tile to render: up to sample `end`, then in steps of `step` up to `last`.
struct TileWork {
  int number;
  PixelRect rect;
  int end, step, last;
  double seconds;          ///< rendering time of its thread
  std::size_t splats = 0;  ///< number of splats in its message
};

/// The threads of a render, on rank 0 and on others. Derived classes supply tiles and take results;
/// their destructors must call join().
class TileWorkers {
 public:
  TileWorkers(const RenderContext& context, std::unique_ptr<Intersector> first_intersector,
              const IntersectorFactory& make_intersector, Film& film,
              std::span<HistoryMask> emitter_histories, RenderStats& stats)
      : context_(context),
        film_(film),
        stats_(stats),
        first_intersector_(std::move(first_intersector)),
        make_intersector_(make_intersector),
        emitter_histories_(emitter_histories) {}
  TileWorkers(const TileWorkers&) = delete;
  TileWorkers& operator=(const TileWorkers&) = delete;
  virtual ~TileWorkers() = default;

 protected:
  // Called with the lock held:
  virtual std::optional<TileWork> take() = 0;      ///< returns a tile, or nullopt for now
  [[nodiscard]] virtual bool is_over() const = 0;  ///< returns whether no more tiles will come
  virtual void done(const TileWork& work) = 0;     ///< called when the tile is in the film
  /// Takes the splats of a part of a tile that has just been written into the film.
  virtual void add(int tile, std::span<const Splat> splats) = 0;
  /// Called by each thread between batches, without the lock.
  virtual void between_batches() {}

  /// Starts up to `count` threads, or fewer if the system cannot start as many.
  void start(int count);
  /// Renders tiles until there are no more. Runs on each thread.
  void work();
  /// Tells the threads to stop.
  void stop();
  void fail(std::exception_ptr error);
  void join() {
    stop();
    threads_.clear();
  }

  const RenderContext& context_;
  std::mutex mutex_;  // guards the members below, except pixels of a tile that is being rendered
  std::condition_variable changed_;
  Film& film_;
  RenderStats& stats_;
  int gone_ = 0;  // number of threads that have ended
  bool stopped_ = false;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;

 private:
  [[nodiscard]] std::unique_ptr<Intersector> take_intersector();
  [[nodiscard]] std::optional<TileWork> next();
  [[nodiscard]] bool render(TileRenderer& renderer, const TileWork& work);

  std::unique_ptr<Intersector> first_intersector_;  // for the first thread
  const IntersectorFactory& make_intersector_;
  std::span<HistoryMask> emitter_histories_;
};

}  // namespace raygate
