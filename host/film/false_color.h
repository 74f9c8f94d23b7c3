// False colours: channels of numbers (depths, counts, names) as 8-bit images.
#pragma once

#include <optional>
#include <string>

#include "host/film/display.h"
#include "host/film/film.h"

namespace raygate {

/// From `low` (dark violet) to `high` (yellow).
struct Scale {
  double low = 0.0, high = 0.0;
};

/// The colour at `fraction` of the scale, clamped to [0, 1]: dark violet, blue, green, yellow, as
/// bright as it is large. Equal steps look equally large, also to the colour-blind and in grey.
/// Source: viridis, by S. van der Walt and N. Smith for matplotlib (CC0), at 17 of its 256 places.
[[nodiscard]] Rgb8 viridis(double fraction);

/// A colour for each number, neighbouring ones far apart: for names, where more means nothing.
[[nodiscard]] Rgb8 label_color(std::uint32_t label);

/// The least and the greatest finite number among `count` pixels; 0 to 0 if there is none. Counts
/// (tests, doubts, samples) and errors begin at 0.
[[nodiscard]] Scale scale_of(const Channel& channel, std::size_t count);

/// One number for each pixel of `window`, within a `width` x `height` frame, in colours. Numbers
/// by `scale`, or from the least to the greatest of them; what is not finite stays black. Channels
/// id and objectId get label colours, a miss stays black. The picture's text "Scale" says what was
/// done, as legend() does.
[[nodiscard]] Image8 false_color(int width, int height, const PixelRect& window,
                                 const Channel& channel, const std::optional<Scale>& scale = {});

/// "tests: 0 (dark violet) to 132 (yellow)", for people.
[[nodiscard]] std::string legend(const std::string& name, const Scale& scale);

}  // namespace raygate
