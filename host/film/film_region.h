// A rectangle of a film as bytes, for another process of the same run.
#pragma once

#include <string>
#include <string_view>

#include "host/film/film.h"

namespace raygate {

/// All that `film` has of `rect`, a part of its window.
[[nodiscard]] std::string region_bytes(const Film& film, const PixelRect& rect);

/// Gives `film`, of the same window and with the same arrays, what region_bytes() has taken.
void set_region(Film& film, const PixelRect& rect, std::string_view bytes);

}  // namespace raygate
