// The picture to look at: 8-bit PNG.
#pragma once

#include <string>

#include "host/film/image8.h"

namespace raygate {

/// The bytes of a PNG file of `picture`: 24-bit RGB, marked as sRGB; where the window is a part of
/// the frame, its place is in the oFFs chunk; the texts are tEXt chunks. Equal pictures give equal
/// bytes. Throws std::runtime_error if libpng fails.
[[nodiscard]] std::string encode_png(const Image8& picture);

}  // namespace raygate
