// What a render leaves behind: one value per pixel and channel.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "host/film/film_sums.h"

namespace raygate {

/// The primitive or object of a pixel whose ray hits nothing.
inline constexpr std::uint32_t kNoPrimitive = std::numeric_limits<std::uint32_t>::max();

/// Pixels [x0, x1) x [y0, y1) of a larger picture, row 0 at the top.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
};

/// What a film holds only if it was asked for.
struct ExtraChannels {
  bool position = false, albedo = false, object = false, tests = false, doubts = false;
  bool sums = false;  ///< what a render goes on from
};

/// Scene-linear picture of `window` (the crop) within a `width` x `height` frame.
///
/// All arrays have window.width() * window.height() elements, row-major, top row first; those of
/// channels that nobody asked for are empty. With several samples in a pixel, `color` and `albedo`
/// are their filtered mean, `tests` and `doubts` their sum; the others cannot be mixed and are the
/// first sample's.
struct Film {
  int width = 0, height = 0;
  PixelRect window;
  std::vector<glm::vec4>
      color;                 ///< R G B A, scene-linear, premultiplied; A = 0 where nothing is hit
  std::vector<float> depth;  ///< Z: distance along the camera's axis; +infinity for a miss
  std::vector<glm::vec3> normal;         ///< unit shading normal towards the viewer; 0 for a miss
  std::vector<std::uint32_t> primitive;  ///< triangle index of the scene; kNoPrimitive for a miss

  // On demand.
  std::vector<glm::vec3> position;    ///< what the camera's ray hits, in world axes; 0 for a miss
  std::vector<glm::vec3> albedo;      ///< its diffuse colour, textured; 0 for a miss
  std::vector<std::uint32_t> object;  ///< index into Scene::objects; kNoPrimitive for a miss
  /// Ray against polygon, of the camera's ray and of all that follow from it. How many were needed
  /// depends on the engine, the skips and the window, not on the number of threads.
  std::vector<std::uint32_t> tests;
  std::vector<std::uint32_t> doubts;  ///< those tests that float32 could not decide
  /// Where there is more to come; files have them if they were asked for.
  FilmSums sums;
  bool keeps_sums = false;

  /// Where a pixel of the window is in the arrays.
  [[nodiscard]] std::size_t index_of(int x, int y) const {
    return std::size_t(y - window.y0) * std::size_t(window.width()) + std::size_t(x - window.x0);
  }
};

/// Calls `visit` with the first array of pixels that a film may have, of each of `films`, then with
/// the second, and so on.
template <class Visit, class... Films>
void for_each_array(const Visit& visit, Films&... films) {
  visit(films.color...);
  visit(films.depth...);
  visit(films.normal...);
  visit(films.primitive...);
  visit(films.position...);
  visit(films.albedo...);
  visit(films.object...);
  visit(films.tests...);
  visit(films.doubts...);
  visit(films.sums.samples...);
  visit(films.sums.color...);
  visit(films.sums.albedo...);
  visit(films.sums.error...);
  visit(films.sums.shown...);
}
static_assert(sizeof(FilmSums) == 5 * sizeof(std::vector<int>) &&
                  sizeof(Film) == 14 * sizeof(std::vector<int>) + 2 * sizeof(PixelRect),
              "for_each_array() has them all");

/// A film of `window` with the arrays that `extra` asks for, but for sums, in which every pixel is
/// a miss.
[[nodiscard]] Film make_film(int width, int height, const PixelRect& window,
                             const ExtraChannels& extra);

/// Gives it sums of no samples; `with_error`: also what films have whose pixels get samples by
/// their error.
void add_sums(Film& film, bool with_error);

}  // namespace raygate
