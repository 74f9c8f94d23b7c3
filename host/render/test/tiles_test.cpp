// Tiles cover the window once, passes all samples, for any number of threads.
#include "host/render/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/render/splat_layer.h"

namespace raygate {
namespace {

TEST(Tiles, CoverEachPixelOnceAndAllSamples) {
  int cases = 0;
  for (const PixelRect window : {PixelRect{0, 0, 1, 1}, {3, 5, 100, 41}, {7, 0, 647, 480}}) {
    for (const int samples : {1, 2, 4, 5, 300}) {
      for (const int threads : {2, 4, 2000}) {
        for (const std::size_t batch : {1 << 14, 1 << 20}) {
          const Tiles tiles(window, samples, batch, threads);
          std::vector<int> covered(std::size_t(window.width()) * std::size_t(window.height()), 0);
          for (int i = 0; i < tiles.count; ++i) {
            const PixelRect tile = tiles[i];
            ASSERT_GT(tile.width(), 0);
            ASSERT_GT(tile.height(), 0);
            for (int y = tile.y0; y < tile.y1; ++y) {
              for (int x = tile.x0; x < tile.x1; ++x) {
                ++covered[std::size_t(y - window.y0) * std::size_t(window.width()) +
                          std::size_t(x - window.x0)];
              }
            }
          }
          EXPECT_EQ(std::ranges::count(covered, 1), std::ssize(covered));
          EXPECT_EQ(tiles.samples_after(tiles.passes() - 1), samples);
          EXPECT_EQ(tiles.passes() == 1, tiles.samples_per_pass == samples);
          ++cases;
        }
      }
    }
  }
  EXPECT_EQ(cases, 90);
}

TEST(SplatLayer, LeavesOutWhatNoIntCanPlace) {
  Film film = make_film(4, 4, {0, 0, 4, 4}, {});
  add_sums(film, false);
  std::ranges::fill(film.sums.samples, 1u);
  SplatLayer layer(film.window, ReconstructionFilter::kBox);
  for (const double far : {1e300, -1e300}) {
    const Splat splats[] = {{{far, 1.0}, glm::dvec3(1.0)}, {{1.0, far}, glm::dvec3(1.0)}};
    layer.add(splats);
  }
  layer.add_to(film);
  for (const glm::vec4& color : film.color) EXPECT_EQ(color, glm::vec4(0.0f));
}

}  // namespace
}  // namespace raygate
