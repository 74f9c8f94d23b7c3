#include "host/render/tile_workers.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "host/base/stopwatch.h"

namespace raygate {

void TileWorkers::start(int count) {
  try {
    while (static_cast<int>(threads_.size()) < count) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): these will do
  }
}

void TileWorkers::work() {
  try {
    const auto intersector = take_intersector();
    TileRenderer renderer(context_, *intersector, film_, emitter_histories_);
    while (auto work = next()) {
      Stopwatch watch;
      if (!render(renderer, *work)) break;
      work->seconds = watch.lap();
      const std::scoped_lock lock(mutex_);
      done(*work);
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

std::unique_ptr<Intersector> TileWorkers::take_intersector() {
  {
    const std::scoped_lock lock(mutex_);
    if (first_intersector_) return std::move(first_intersector_);
  }
  return make_intersector_();
}

/// Returns the next tile, or nullopt if there is none left or the threads must stop.
std::optional<TileWork> TileWorkers::next() {
  std::unique_lock lock(mutex_);
  std::optional<TileWork> work;
  changed_.wait(lock, [&] {
    if (stopped_ || is_over()) return true;
    work = take();
    return work.has_value();
  });
  return work;
}

/// Renders a tile. Returns false if it was stopped. No other thread accesses its pixels meanwhile.
bool TileWorkers::render(TileRenderer& renderer, const TileWork& work) {
  const auto keep_going = [this] {
    between_batches();
    const std::scoped_lock lock(mutex_);
    return !stopped_;
  };
  for (int end = work.end;; end = std::min(end + work.step, work.last)) {
    if (!renderer.trace(work.rect, end, keep_going)) return false;
    const std::scoped_lock lock(mutex_);
    renderer.write();
    add(work.number, renderer.splats());
    if (end == work.last) return true;
  }
}

void TileWorkers::stop() {
  const std::scoped_lock lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

void TileWorkers::fail(std::exception_ptr error) {
  {
    const std::scoped_lock lock(mutex_);
    if (!error_) error_ = std::move(error);
  }
  stop();
}

}  // namespace raygate
