// A film as a list of named channels, as picture files have them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/film/film.h"

namespace raygate {

/// One number of each pixel of a film. Valid as long as the film's arrays are.
struct Channel {
  enum class Type { kFloat, kUint };  ///< float or std::uint32_t

  std::string name;  ///< as in OpenEXR: "R", "Z", "N.X", "id"
  Type type;
  const void* first;   ///< of the window's first pixel
  std::size_t stride;  ///< bytes from one pixel to the next; rows follow without a gap
};

/// All that the film holds:
///   R G B A  Z  N.X N.Y N.Z  id (the primitive)       always
///   P.X P.Y P.Z (the position)  Albedo.R .G .B
///   objectId  tests  doubts                           those that were asked for
///   samples  error                                    if its pixels got samples by their error
///   samples  sums.R.0 to .5 and so on  sums.shown     if it keeps its sums: ExactAccumulator's
///   words
[[nodiscard]] std::vector<Channel> channels_of(const Film& film);

/// The channel's number at pixel `index` (row by row) as a double, exactly.
[[nodiscard]] double value_at(const Channel& channel, std::size_t index);

}  // namespace raygate
