// 8-bit images for a display: sRGB codes of a film, and PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "host/film/film.h"

namespace raygate {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< sRGB codes

/// Pixels of `window` within a `width` x `height` frame, row by row from the top.
struct Image8 {
  int width = 0, height = 0;
  PixelRect window;
  std::vector<Rgb8> pixels;
  std::vector<std::pair<std::string, std::string>> texts;  ///< tEXt chunks of the PNG file
};

/// Tone curve from scene-linear light to display codes.
enum class Tone {
  kClip,    ///< values above 1 are white; below, the display is linear
  kFilmic,  ///< shadows and highlights are compressed, as by film
};

struct DisplayOptions {
  double exposure = 0.0;  ///< in stops: the light is multiplied by 2^exposure first
  Tone tone = Tone::kClip;
};

/// Returns display-linear light of a channel after exposure, in [0, 1] for kFilmic; NaN stays. The
/// filmic curve is K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
[[nodiscard]] float tone_map(float light, Tone tone);

/// Returns the luminance after `exposure` stops in steps of an 8-bit sRGB display: 255 is white.
/// The curve continues above white, which another exposure can show. Unit of pixel errors.
[[nodiscard]] float display_steps(const glm::vec3& light, double exposure);

/// Returns the film over black. Each code is the nearest to the exact value.
[[nodiscard]] Image8 to_display(const Film& film, const DisplayOptions& options = {});

/// Returns the bytes of a PNG file of `picture`: 24-bit sRGB; the offset of a crop is in the oFFs
/// chunk, the texts are tEXt chunks. Equal pictures give equal bytes. Throws std::runtime_error if
/// libpng fails.
[[nodiscard]] std::string encode_png(const Image8& picture);

/// Returns a message that explains why a film looks blank, and what to try: no pixel hits any
/// geometry, all are black, or all have one colour. Returns "" for other films, and for crops and
/// films of fewer than 16 x 16 pixels, where that is normal.
[[nodiscard]] std::string why_blank(const Film& film, const DisplayOptions& display);

}  // namespace raygate
