// A film with different values in all pixels, for the tests of the encoders.
#pragma once

#include <limits>

#include "host/film/film.h"

namespace raygate {

/// Returns a film of `window` in a `width` x `height` frame, with optional channels if
/// `all_channels`. The first pixel is a miss.
inline Film make_sample_film(int width, int height, PixelRect window, bool all_channels = false) {
  Film film;
  film.width = width;
  film.height = height;
  film.window = window;
  const int count = window.width() * window.height();
  for (int i = 0; i < count; ++i) {
    const float value = static_cast<float>(i) / static_cast<float>(count);
    film.color.emplace_back(value, value / 3.0f, 1.0f - value, 1.0f);
    film.depth.push_back(1.0f / (value + 1e-3f));
    film.normal.emplace_back(value, -value, 1e-40f * static_cast<float>(i));  // with subnormals
    film.primitive.push_back(static_cast<std::uint32_t>(i) * 16777259u);      // needs all 32 bits
  }
  film.color[0] = glm::vec4(0.0f);
  film.depth[0] = std::numeric_limits<float>::infinity();
  film.normal[0] = glm::vec3(0.0f);
  film.primitive[0] = kNoPrimitive;
  if (all_channels) {
    for (int i = 0; i < count; ++i) {
      const float value = static_cast<float>(i);
      film.position.emplace_back(value, -value, value * 1e10f);
      film.albedo.emplace_back(0.5f, value, 1.0f / (value + 1.0f));
      film.object.push_back(static_cast<std::uint32_t>(i) * 33554467u);
      film.tests.push_back(static_cast<std::uint32_t>(i) * 7u);
      film.doubts.push_back(static_cast<std::uint32_t>(i) % 3u);
    }
  }
  return film;
}

}  // namespace raygate
