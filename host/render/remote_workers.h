// Remote workers: the other ranks as rank 0 sees them, and the messages about tiles.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/film/film.h"
#include "host/ranks/ranks.h"
#include "host/render/splat_layer.h"
#include "host/render/tile_queue.h"
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
/// Throws InputError where there are fewer than the message says.
[[nodiscard]] std::vector<Splat> splats_in(const std::string& message);
[[nodiscard]] inline std::string_view region_in(const std::string& message) {
  return std::string_view(message).substr(sizeof(TileWork) +
                                          splats_in(message).size() * sizeof(Splat));
}

/// Hands out tiles and puts what comes back into the film. For one thread at a time, which also
/// has the film and the queue to itself meanwhile.
class RemoteWorkers {
 public:
  /// `first_sample`: of the render. All else must outlive this.
  RemoteWorkers(Ranks& ranks, const Tiles& tiles, int first_sample, Film& film, SplatLayer& splats);

  /// Takes what has come and gives everyone with room for it more to do. True if a tile came back.
  bool serve(TileQueue& queue);

  /// Says that all is traced, and waits for what everyone has to say about it: true once that is
  /// in `stats`, with what serve() has done. False: not yet.
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
  std::vector<int> room_;  // by rank: for so many more tiles
  int most_room_ = 0;      // of all of them, when they had nothing to do
  double seconds_ = 0.0;   // of threads, for ...
  std::int64_t passes_ = 0;
  double serving_ = 0.0;  // seconds of this thread
  std::uint64_t tiles_back_ = 0, bytes_back_ = 0;
  bool told_ = false;
  int heard_ = 0;  // statistics that have come
};

}  // namespace raygate
