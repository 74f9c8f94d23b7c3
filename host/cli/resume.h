// A picture that was begun earlier, for this run to go on from.
#pragma once

#include <optional>

#include "host/cli/options.h"
#include "host/film/exr.h"
#include "host/film/film.h"

namespace raygate {

/// What --resume names, with the channels that this run's outputs need and no others; nothing if
/// it names nothing. `metadata` is what this run's picture says of itself. Throws InputError: a
/// file that cannot be read, keeps no sums, or is not of the picture that this run renders; only
/// --spp may have grown.
[[nodiscard]] std::optional<Film> begun_film(const Options& options, const ExrMetadata& metadata);

}  // namespace raygate
