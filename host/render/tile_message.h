// What ranks tell each other about a tile.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "host/film/film.h"
#include "host/ranks/ranks.h"

namespace raygate {

/// Samples to trace: up to number `end`, `step` more, and so on to `last`. With it goes what the
/// film has of the tile (film_region.h), there where the worker lacks it, and back what it has
/// then.
struct TileMessage {
  int number;
  PixelRect rect;
  int end, step, last;
  double seconds;  ///< that one thread took; of what came back
};

[[nodiscard]] inline std::string message_of(const TileMessage& tile, std::string_view slice) {
  return bytes_of(tile).append(slice);
}
[[nodiscard]] inline std::string_view slice_in(const std::string& message) {
  return std::string_view(message).substr(sizeof(TileMessage));
}

}  // namespace raygate
