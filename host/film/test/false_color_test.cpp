#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "host/base/elementary.h"
#include "host/film/display.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

/// Returns the CIE 1976 lightness of sRGB codes.
double lightness(const Rgb8& color) {
  const double y = 0.2126 * srgb_to_linear(color[0]) + 0.7152 * srgb_to_linear(color[1]) +
                   0.0722 * srgb_to_linear(color[2]);
  return 116.0 * std::cbrt(y) - 16.0;
}

TEST(FalseColor, ViridisHasItsPublishedColors) {
  EXPECT_EQ(viridis(0.0), (Rgb8{68, 1, 84}));
  EXPECT_EQ(viridis(1.0), (Rgb8{253, 231, 37}));
  // Entries 37, 93 and 200 of matplotlib's 256 colours, which viridis() interpolates.
  const std::pair<int, Rgb8> published[] = {
      {37, {70, 51, 127}}, {93, {45, 112, 142}}, {200, {112, 207, 87}}};
  for (const auto& [entry, color] : published) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(viridis(entry / 255.0)[k], color[k], 6);
  }
  EXPECT_EQ(viridis(-1.0), viridis(0.0));
  EXPECT_EQ(viridis(2.0), viridis(1.0));
}

TEST(FalseColor, EqualStepsGrowEquallyBrighter) {
  const double step = (lightness(viridis(1.0)) - lightness(viridis(0.0))) / 16.0;
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(lightness(viridis((i + 1) / 16.0)) - lightness(viridis(i / 16.0)), step,
                0.3 * step);
  }
}

TEST(FalseColor, LabelsDiffer) {
  std::set<Rgb8> colors;
  for (std::uint32_t label = 0; label < 100; ++label) colors.insert(label_color(label));
  EXPECT_EQ(colors.size(), 100u);
  EXPECT_EQ(colors.count(Rgb8{0, 0, 0}), 0u) << "black is for misses";
}

TEST(FalseColor, ScalesFromTheLeastToTheGreatestFiniteNumber) {
  Film film = make_sample_film(4, 1, {0, 0, 4, 1}, true);
  film.depth = {2.0f, std::numeric_limits<float>::infinity(), 6.0f, 4.0f};
  film.tests = {5, 3, 8, 4};
  const Image8 depth = false_color(film, "Z");
  EXPECT_EQ(depth.pixels,
            (std::vector<Rgb8>{viridis(0.0), Rgb8{0, 0, 0}, viridis(1.0), viridis(0.5)}));
  ASSERT_EQ(depth.texts.size(), 1u);
  EXPECT_EQ(depth.texts[0].second, "Z: 2 (dark violet) to 6 (yellow)");
  EXPECT_EQ(false_color(film, "tests").pixels[3], viridis(0.5)) << "counts begin at 0";
}

TEST(FalseColor, OneNumberOrNone) {
  Film film = make_sample_film(2, 1, {0, 0, 2, 1});
  film.depth = {3.0f, 3.0f};
  EXPECT_EQ(false_color(film, "Z").pixels[1], viridis(0.0));
  film.depth = {NAN, NAN};
  EXPECT_EQ(false_color(film, "Z").pixels[1], (Rgb8{0, 0, 0}));
}

TEST(FalseColor, MissesHaveNoLabel) {
  Film film = make_sample_film(3, 1, {0, 0, 3, 1});
  film.primitive = {kNoPrimitive, 7, 8};
  EXPECT_EQ(false_color(film, "id").pixels,
            (std::vector<Rgb8>{Rgb8{0, 0, 0}, label_color(7), label_color(8)}));
}

}  // namespace
}  // namespace raygate
