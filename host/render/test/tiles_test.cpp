// For any number of threads, tiles cover the window once and passes cover all samples. Every pass
// of every tile begins once, in the order of the tile's passes, and no tile waits for another.
#include "host/render/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "host/render/tile_renderer.h"

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

TEST(TileQueue, EveryPassOfEveryTileInTheTilesOrder) {
  constexpr int kTiles = 7, kPasses = 5;
  TileQueue queue(kTiles, kPasses);
  std::vector<int> passes(kTiles, 0);
  std::vector<TileQueue::Step> at_work;
  std::mt19937 random(3);
  while (!queue.all_ended()) {
    const auto step = at_work.size() < 3 ? queue.begin() : std::nullopt;
    if (step) {
      EXPECT_EQ(step->pass, passes[static_cast<std::size_t>(step->tile)]++);
      for (const auto& other : at_work) EXPECT_NE(other.tile, step->tile);
      at_work.push_back(*step);
    } else {
      ASSERT_FALSE(at_work.empty());
      std::swap(at_work[random() % at_work.size()], at_work.back());
      queue.end(at_work.back());
      at_work.pop_back();
    }
  }
  EXPECT_TRUE(queue.all_begun());
  EXPECT_EQ(queue.fraction(), 1.0);
  EXPECT_EQ(passes, std::vector<int>(kTiles, kPasses));
}

TEST(TileQueue, ATileGoesOnWhileAnotherIsSlow) {
  TileQueue queue(2, 3);
  const auto slow = queue.begin();
  for (int pass = 0; pass < 3; ++pass) {
    const auto step = queue.begin();
    ASSERT_TRUE(step);
    EXPECT_NE(step->tile, slow->tile);
    EXPECT_EQ(step->pass, pass);
    queue.end(*step);
  }
  EXPECT_FALSE(queue.begin()) << "the slow tile's second pass before its first one's end";
  EXPECT_FALSE(queue.all_begun());
  queue.end(*slow);
  EXPECT_TRUE(queue.begin());
}

/// A picture of 8192 x 8192 pixels with 2^20 samples has 2^32 steps.
TEST(TileQueue, CountsBeyond32Bits) {
  TileQueue queue(1 << 14, 1 << 18);
  EXPECT_FALSE(queue.all_begun());
  const auto step = queue.begin();
  ASSERT_TRUE(step);
  queue.end(*step);
  EXPECT_FALSE(queue.all_ended());
  EXPECT_EQ(queue.fraction(), 0x1p-32);
}

}  // namespace
}  // namespace raygate
