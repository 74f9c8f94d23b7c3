// False colours: channels such as depths, counts and ids as 8-bit images.
#pragma once

#include <optional>
#include <string>

#include "host/film/display.h"
#include "host/film/film.h"

namespace raygate {

/// The range of a colour scale, from `low` (dark violet) to `high` (yellow).
struct Scale {
  double low = 0.0, high = 0.0;
};

/// Returns the colour at `fraction` of the scale, clamped to [0, 1]: viridis, by S. van der Walt
/// and N. Smith for matplotlib (CC0), interpolated from 17 of its 256 colours. It is perceptually
/// uniform, also for the colour-blind and in grey.
[[nodiscard]] Rgb8 viridis(double fraction);

/// Returns a colour for an id; neighbouring ids have very different colours.
[[nodiscard]] Rgb8 label_color(std::uint32_t label);

/// Returns the range of the finite values of `count` pixels; 0 to 0 if there are none. Ranges of
/// counts (tests, doubts, samples) and errors start at 0.
[[nodiscard]] Scale scale_of(const Channel& channel, std::size_t count);

/// Returns a channel of `window`, within a `width` x `height` frame, in colours of `scale` or of
/// scale_of(). Values that are not finite are black. Channels id and objectId have label colours,
/// and misses are black. The picture's text "Scale" is the legend().
[[nodiscard]] Image8 false_color(int width, int height, const PixelRect& window,
                                 const Channel& channel, const std::optional<Scale>& scale = {});

/// Returns a legend: "tests: 0 (dark violet) to 132 (yellow)".
[[nodiscard]] std::string legend(const std::string& name, const Scale& scale);

}  // namespace raygate
