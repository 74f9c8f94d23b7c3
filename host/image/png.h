// The picture to look at: 8-bit PNG.
#pragma once

#include <string>

#include "host/render/film.h"

namespace raygate {

/// The bytes of a PNG file of `film`: 24-bit RGB in sRGB (and marked as such), over black, of the
/// film's window alone; where the window is a crop, its place is in the oFFs chunk. The bytes
/// depend on the film's colours and nothing else. Throws std::runtime_error if libpng fails.
[[nodiscard]] std::string encode_png(const Film& film);

}  // namespace raygate
