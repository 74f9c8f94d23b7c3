#include "host/film/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/srgb.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

void expect_codes(const Film& film, const DisplayOptions& options, float gain) {
  const Image8 picture = to_display(film, options);
  EXPECT_EQ(picture.width, film.width);
  EXPECT_EQ(picture.window.x0, film.window.x0);
  ASSERT_EQ(picture.pixels.size(), film.color.size());
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(picture.pixels[i][static_cast<std::size_t>(k)],
                linear_to_srgb(gain * film.color[i][k]));
    }
  }
}

TEST(Display, IsPlainSrgbUnlessToldOtherwise) {
  expect_codes(make_sample_film(67, 41, {3, 2, 67, 41}), {}, 1.0f);
}

TEST(Display, AStopDoublesTheLight) {
  const Film film = make_sample_film(32, 32, {0, 0, 32, 32});
  expect_codes(film, {.exposure = 1.0, .tone = Tone::kClip}, 2.0f);
  expect_codes(film, {.exposure = -3.0, .tone = Tone::kClip}, 0.125f);
}

TEST(Display, FilmicToneIsMonotoneAndBounded) {
  EXPECT_EQ(tone_map(0.0f, Tone::kFilmic), 0.0f);
  float last = 0.0f;
  for (float light = 1e-3f; light < 1e4f; light *= 1.1f) {
    const float now = tone_map(light, Tone::kFilmic);
    EXPECT_GE(now, last);
    EXPECT_LE(now, 1.0f);
    last = now;
  }
  EXPECT_NEAR(tone_map(0.18f, Tone::kFilmic), 0.26689f, 1e-4f);  // the formula by hand
  EXPECT_LT(tone_map(1.0f, Tone::kFilmic), 0.9f) << "room is left for brighter light";
  EXPECT_EQ(tone_map(kInfinity, Tone::kFilmic), 1.0f);
  EXPECT_EQ(tone_map(-1.0f, Tone::kFilmic), 0.0f);
  EXPECT_TRUE(std::isnan(tone_map(std::numeric_limits<float>::quiet_NaN(), Tone::kFilmic)));
  EXPECT_EQ(tone_map(7.0f, Tone::kClip), 7.0f);
}

}  // namespace
}  // namespace raygate
