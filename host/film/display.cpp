#include "host/film/display.h"

#include <algorithm>
#include <cmath>

#include "host/base/elementary.h"
#include "host/base/srgb.h"

namespace raygate {
namespace {

double gain_of(double exposure) { return binary_power(std::clamp(exposure, -126.0, 127.0)); }

}  // namespace

float tone_map(float light, Tone tone) {
  if (tone == Tone::kClip) return light;
  // The quotient of two squares would be NaN for infinite light.
  const double x = std::min(std::max(light, 0.0f), 1e6f);
  if (std::isnan(light)) return light;
  return static_cast<float>(std::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0));
}

float display_steps(const glm::vec3& light, double exposure) {
  const glm::dvec3 c(light);
  return static_cast<float>(
      255.0 * srgb_curve_above(gain_of(exposure) * (0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b)));
}

Image8 to_display(const Film& film, const DisplayOptions& options) {
  Image8 picture{film.width, film.height, film.window, {}, {}};
  picture.pixels.reserve(film.color.size());
  const auto gain = static_cast<float>(gain_of(options.exposure));
  for (const glm::vec4& color : film.color) {
    Rgb8& codes = picture.pixels.emplace_back();
    for (int k = 0; k < 3; ++k) {
      codes[static_cast<std::size_t>(k)] = linear_to_srgb(tone_map(gain * color[k], options.tone));
    }
  }
  return picture;
}

}  // namespace raygate
