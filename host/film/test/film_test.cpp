// A rectangle of a film, there and back.
#include "host/film/film.h"

#include <gtest/gtest.h>

#include "host/base/input_error.h"
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

TEST(FilmRegion, BringsAllChannelsOfItsPixelsAndNoOthers) {
  const PixelRect window{3, 5, 16, 14};
  const Film source = with_sums(make_sample_film(20, 18, window, true));
  Film target = source;
  const auto blank_out = [](const FilmField&, auto& values) {
    ASSERT_FALSE(values.empty());
    values.assign(values.size(), {});
  };
  for_each_field(blank_out, target);
  const Film blank = target;
  const PixelRect rect{4, 7, 9, 14};
  set_region(target, rect, region_bytes(source, rect));
  int inside = 0;
  for (int y = window.y0; y < window.y1; ++y) {
    for (int x = window.x0; x < window.x1; ++x) {
      const bool is_in = x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1;
      const PixelRect pixel{x, y, x + 1, y + 1};
      EXPECT_EQ(region_bytes(target, pixel), region_bytes(is_in ? source : blank, pixel));
      inside += static_cast<int>(is_in);
    }
  }
  EXPECT_EQ(inside, 35);
}

TEST(FilmRegion, RefusesOtherBytesAndOtherPixels) {
  const Film source = make_sample_film(20, 18, {3, 5, 16, 14}, true);
  Film target = source;
  const std::string bytes = region_bytes(source, {4, 7, 9, 14});
  EXPECT_THROW(set_region(target, {4, 7, 9, 13}, bytes), InputError);
  EXPECT_THROW(set_region(target, {4, 7, 9, 14}, bytes.substr(1)), InputError);
  EXPECT_THROW(set_region(target, {12, 7, 17, 14}, bytes), InputError);
  EXPECT_THROW(set_region(target, {2, 7, 7, 14}, bytes), InputError);
  EXPECT_THROW(set_region(target, {4, 8, 9, 15}, bytes), InputError);
  EXPECT_EQ(region_bytes(target, target.window), region_bytes(source, source.window));
}

TEST(FilmRegion, HasEachNumberOnce) {
  const Film film = with_sums(make_sample_film(4, 4, {0, 0, 4, 4}, true));
  std::size_t bytes = 0;
  for_each_field([&](const FilmField&, const auto& values) { bytes += sizeof(values[0]); }, film);
  EXPECT_EQ(bytes,
            4 * (4 + 1 + 3 + 1 + 3 + 3 + 1 + 1 + 1 + 1 + 1 + 1) + 7 * sizeof(ExactAccumulator));
  EXPECT_EQ(region_bytes(film, {1, 1, 2, 2}).size(), bytes);
}

TEST(FilmRegion, LeavesOutWhatAFilmDoesNotHave) {
  const Film film = make_sample_film(4, 4, {0, 0, 4, 4});
  const std::size_t bytes = sizeof(glm::vec4) + sizeof(float) + sizeof(glm::vec3) + 4;
  EXPECT_EQ(region_bytes(film, {1, 1, 3, 2}).size(), 2 * bytes);
}

}  // namespace
}  // namespace raygate
