// Blank pictures are told, and no others.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/film/display.h"

namespace raygate {
namespace {

Film film_of(const glm::vec4& color, std::uint32_t primitive) {
  Film film = make_film(16, 16, {0, 0, 16, 16}, {});
  std::ranges::fill(film.color, color);
  std::ranges::fill(film.primitive, primitive);
  return film;
}

bool begins(const std::string& text, std::string_view start) { return text.starts_with(start); }

TEST(WhyBlank, SaysWhatIsWrong) {
  const char* const kNothing = "the camera sees nothing";
  EXPECT_PRED2(begins, why_blank(film_of({0, 0, 0, 0}, kNoPrimitive), {}), kNothing);
  EXPECT_PRED2(begins, why_blank(film_of({0.2f, 0.2f, 0.2f, 1}, kNoPrimitive), {}), kNothing);
  EXPECT_PRED2(begins, why_blank(film_of({0, 0, 0, 1}, 3), {}), "the picture is black");
  EXPECT_PRED2(begins, why_blank(film_of({2, 2, 2, 1}, 3), {}), "the picture is all one colour");
}

TEST(WhyBlank, SaysNothingWhereThereIsSomethingToSee) {
  Film film = film_of({0.2f, 0.2f, 0.2f, 1}, 3);
  film.color[100].g = 0.21f;
  EXPECT_EQ(why_blank(film, {}), "");
  film = film_of({2, 2, 2, 1}, 3);
  film.color[7] = {0.5f, 2, 2, 1};
  EXPECT_EQ(why_blank(film, {}), "");
  EXPECT_PRED2(begins, why_blank(film, {.exposure = 3.0}), "the picture is all one colour");
}

TEST(WhyBlank, SaysNothingOfCropsAndThumbnails) {
  EXPECT_EQ(why_blank(make_film(64, 64, {0, 0, 32, 32}, {}), {}), "");
  EXPECT_EQ(why_blank(make_film(8, 8, {0, 0, 8, 8}, {}), {}), "");
}

}  // namespace
}  // namespace raygate
