// A rectangle of a film as bytes, for another process of the same run.
#pragma once

#include <string>
#include <string_view>

#include "host/film/film.h"

namespace raygate {

static_assert(sizeof(FilmSums) == 5 * sizeof(std::vector<int>), "for_each_array() has them all");

/// Calls `visit` with each array of pixels that a film may have.
template <class AnyFilm, class Visit>
void for_each_array(AnyFilm& film, const Visit& visit) {
  visit(film.color);
  visit(film.depth);
  visit(film.normal);
  visit(film.primitive);
  visit(film.position);
  visit(film.albedo);
  visit(film.object);
  visit(film.tests);
  visit(film.doubts);
  visit(film.sums.samples);
  visit(film.sums.color);
  visit(film.sums.albedo);
  visit(film.sums.error);
  visit(film.sums.shown);
  visit(film.sums.error);
  visit(film.sums.shown);
}

/// All that `film` has of `rect`, a part of its window.
[[nodiscard]] std::string slice_of(const Film& film, const PixelRect& rect);

/// Gives `film`, of the same window and with the same arrays, what slice_of() has taken.
void put_slice(Film& film, const PixelRect& rect, std::string_view slice);

}  // namespace raygate
