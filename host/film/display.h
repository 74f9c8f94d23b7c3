// Images of 8 bits for a display: sRGB codes of a film, and PNG files.
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
  std::vector<std::pair<std::string, std::string>> texts;  ///< what the file says of itself
};

/// How light of more than a display can show becomes a code.
enum class Tone {
  kClip,    ///< everything above 1 is white; below, the display shows the light as it is
  kFilmic,  ///< dark and bright ends are compressed smoothly, as film does it
};

/// How a film is shown.
struct DisplayOptions {
  double exposure = 0.0;  ///< in stops: the light is multiplied by 2^exposure first
  Tone tone = Tone::kClip;
};

/// Light of one channel, after exposure, as the light that the display gives off: in [0, 1] for
/// kFilmic; NaN stays. Source of the curve: K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
[[nodiscard]] float tone_map(float light, Tone tone);

/// Luminance as a display shows it after `exposure` stops, in steps of its 8 bits: 255 is white.
/// The sRGB curve goes on above white, which another exposure may bring into sight. What errors of
/// a pixel are measured in.
[[nodiscard]] float display_steps(const glm::vec3& light, double exposure);

/// The film over black, channel by channel. Each code is the one nearest to the exact value.
[[nodiscard]] Image8 to_display(const Film& film, const DisplayOptions& options = {});

/// The bytes of a PNG file of `picture`: 24-bit RGB, marked as sRGB; where the window is a part of
/// the frame, its place is in the oFFs chunk; the texts are tEXt chunks. Equal pictures give equal
/// bytes. Throws std::runtime_error if libpng fails.
[[nodiscard]] std::string encode_png(const Image8& picture);

/// Whether this is a PNG file that nothing has damaged: its chunks follow each other up to IEND,
/// the last, and each has its checksum (PNG, Third Edition, 5.3 to 5.6). What they say is not read.
[[nodiscard]] bool is_whole_png(const std::filesystem::path& file);

/// Why nothing can be seen in a film, and what to try: no pixel has hit anything, all are black, or
/// all have one colour. Empty where something is seen, and of films that are only a crop or smaller
/// than 16 x 16 pixels, where that is nothing special.
[[nodiscard]] std::string why_blank(const Film& film, const DisplayOptions& display);

}  // namespace raygate
