// 8-bit images for a display: sRGB codes of a film, false colours of a channel, and PNG files.
#pragma once

#include <array>
#include <cstdint>
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

/// Returns display-linear light for one channel of light after exposure; in [0, 1] for kFilmic.
/// Returns NaN for NaN. The filmic curve is K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
[[nodiscard]] float tone_map(float light, Tone tone);

/// Returns the luminance of `light` after `exposure` stops as a fractional 8-bit sRGB code; 255 is
/// white. Not clamped, because values above white can be visible at another exposure.
[[nodiscard]] float display_steps(const glm::vec3& light, double exposure);

/// Returns sRGB codes of the film over black. Each code is the nearest to the exact value.
[[nodiscard]] Image8 to_display(const Film& film, const DisplayOptions& options = {});

/// Returns a PNG file, 24-bit sRGB, with the offset of a crop in the oFFs chunk and texts in tEXt
/// chunks. Equal pictures give equal bytes. Throws std::runtime_error if libpng fails.
[[nodiscard]] std::string encode_png(const Image8& picture);

/// Returns the colour at `fraction`, clamped to [0, 1], of viridis, the perceptually uniform map by
/// S. van der Walt and N. Smith for matplotlib (CC0). Interpolates 17 of its 256 colours.
[[nodiscard]] Rgb8 viridis(double fraction);

/// Returns a colour for an id; neighbouring ids have very different colours.
[[nodiscard]] Rgb8 label_color(std::uint32_t label);

/// Returns a channel of the film in viridis colours over the range of its finite values. Ranges of
/// counts (tests, doubts, samples) and errors start at 0. Values that are not finite are black.
/// Channels id and objectId have label colours, and misses are black. The picture's text "Scale" is
/// a legend: "tests: 0 (dark violet) to 132 (yellow)". Throws InputError if the channel is missing.
[[nodiscard]] Image8 false_color(const Film& film, const std::string& channel);

}  // namespace raygate
