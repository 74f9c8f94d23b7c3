// Every pass of every tile once, a tile's in their order, and no tile waits for another.
#include <gtest/gtest.h>

#include <random>

#include "host/render/tiles.h"

namespace raygate {
namespace {

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
      queue.end(at_work.back().tile);
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
    queue.end(step->tile);
  }
  EXPECT_FALSE(queue.begin()) << "the slow tile's second pass before its first one's end";
  EXPECT_FALSE(queue.all_begun());
  queue.end(slow->tile);
  EXPECT_TRUE(queue.begin());
}

/// 8192 x 8192 pixels and 2^20 samples: 2^32 steps.
TEST(TileQueue, CountsBeyond32Bits) {
  TileQueue queue(1 << 14, 1 << 18);
  EXPECT_FALSE(queue.all_begun());
  const auto step = queue.begin();
  ASSERT_TRUE(step);
  queue.end(step->tile);
  EXPECT_FALSE(queue.all_ended());
  EXPECT_EQ(queue.fraction(), 0x1p-32);
}

}  // namespace
}  // namespace raygate
