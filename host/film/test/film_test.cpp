// Copies a rectangle of a film.
#include "host/film/film.h"

#include <gtest/gtest.h>

#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

Film with_sums(Film film) {
  film.sums.samples.assign(film.color.size(), 3);
  film.sums.color.resize(film.color.size());
  film.sums.albedo.resize(film.albedo.size());
  film.sums.error.assign(film.color.size(), 0.5f);
  film.sums.shown.assign(film.color.size(), 99.0f);
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    film.sums.color[i][2].add(double(i) / 3.0);
    film.sums.albedo[i][1].add(-double(i));
  }
  return film;
}

TEST(FilmRegion, CopiesAllChannelsOfItsPixelsAndNoOthers) {
  const PixelRect window{3, 5, 16, 14}, rect{4, 7, 9, 14};
  const Film source = with_sums(make_sample_film(20, 18, window, true));
  Film target = source;
  const auto blank_out = [](const FilmField&, auto& values) {
    ASSERT_FALSE(values.empty());
    values.assign(values.size(), {});
  };
  for_each_field(blank_out, target);
  const Film blank = target;
  copy_region(source, rect, target);
  const auto compare = [&](const FilmField&, const auto& from, const auto& to, const auto& before) {
    for (int y = window.y0; y < window.y1; ++y) {
      for (int x = window.x0; x < window.x1; ++x) {
        const bool is_in = x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1;
        const std::size_t i = target.index_of(x, y);
        EXPECT_EQ(to[i], (is_in ? from : before)[i]);
      }
    }
  };
  for_each_field(compare, source, target, blank);
}

}  // namespace
}  // namespace raygate
