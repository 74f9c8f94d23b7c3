#include "host/film/film.h"

namespace raygate {

Film make_film(int width, int height, const PixelRect& window, const ExtraChannels& extra) {
  Film film;
  film.width = width;
  film.height = height;
  film.window = window;
  film.keeps_sums = extra.sums;
  const std::size_t pixels = std::size_t(window.width()) * std::size_t(window.height());
  film.color.assign(pixels, glm::vec4(0.0f));
  film.depth.assign(pixels, std::numeric_limits<float>::infinity());
  film.normal.assign(pixels, glm::vec3(0.0f));
  film.primitive.assign(pixels, kNoPrimitive);
  if (extra.position) film.position.assign(pixels, glm::vec3(0.0f));
  if (extra.albedo) film.albedo.assign(pixels, glm::vec3(0.0f));
  if (extra.object) film.object.assign(pixels, kNoPrimitive);
  if (extra.tests) film.tests.assign(pixels, 0);
  if (extra.doubts) film.doubts.assign(pixels, 0);
  return film;
}

void add_sums(Film& film, bool with_error) {
  const std::size_t pixels = film.color.size();
  film.sums.samples.assign(pixels, 0);
  film.sums.color.resize(pixels);
  film.sums.albedo.resize(film.albedo.size());
  if (!with_error) return;
  film.sums.error.assign(pixels, std::numeric_limits<float>::infinity());
  film.sums.shown.assign(pixels, 0.0f);
}

}  // namespace raygate
