// Remote workers: the other ranks as seen by rank 0, and messages about tiles.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/film/film.h"
#include "host/ranks/ranks.h"
#include "host/render/splat_layer.h"
#include "host/render/tile_workers.h"
#include "host/render/tiles.h"

namespace raygate {

/// Encodes a message about a tile. To the worker: the work, and the film's data of the tile if the
/// worker lacks it. From the worker: the work, its splats, and the film's data of the tile.
[[nodiscard]] inline std::string message_of(TileWork work, std::string_view region,
                                            std::span<const Splat> splats = {}) {
  work.splats = splats.size();
  return bytes_of(work)
      .append(reinterpret_cast<const char*>(splats.data()), splats.size_bytes())
      .append(region);
}
/// Returns the splats of a message. Throws InputError if there are fewer than stated.
[[nodiscard]] std::vector<Splat> splats_in(const std::string& message);
[[nodiscard]] inline std::string_view region_in(const std::string& message) {
  return std::string_view(message).substr(sizeof(TileWork) +
                                          splats_in(message).size() * sizeof(Splat));
}

/// Sends tiles to the other ranks and stores their results in the film. Used by one thread at a
/// time, which must have exclusive access to the film and the queue during a call.
class RemoteWorkers {
 public:
  /// `first_sample` is that of the render. The references must outlive this object.
  RemoteWorkers(Ranks& ranks, const Tiles& tiles, int first_sample, Film& film, SplatLayer& splats);

  /// Stores results and sends work to ranks with free capacity. Returns whether a tile arrived.
  bool serve(TileQueue& queue);

  /// Tells the ranks that the render is complete and collects their statistics. Returns true once
  /// all are in `stats`; call it again until then.
  bool finish(RenderStats& stats);

 private:
  void take(const Message& message, TileQueue& queue);
  [[nodiscard]] int most_passes(const TileQueue& queue) const;
  void give(int rank, const TileQueue::Step& step);

  Ranks& ranks_;
  const Tiles& tiles_;
  int first_sample_;
  Film& film_;
  SplatLayer& splats_;
  std::vector<int> room_;  // by rank: number of further tiles that it can take
  int most_room_ = 0;      // of all ranks together, when idle
  double seconds_ = 0.0;   // thread seconds of `passes_`
  std::int64_t passes_ = 0;
  double serving_ = 0.0;  // seconds spent in serve()
  std::uint64_t tiles_back_ = 0, bytes_back_ = 0;
  bool told_ = false;
  int heard_ = 0;  // number of ranks whose statistics have arrived
};

/// Renders the tiles that rank 0 sends on options.threads threads, until rank 0 ends the render or
/// `monitor` stops it. `film`, which has sums, holds this rank's tiles. Rethrows exceptions of
/// intersectors; throws RunIsOver.
void run_worker(Ranks& ranks, const RenderContext& context,
                std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats);

}  // namespace raygate
