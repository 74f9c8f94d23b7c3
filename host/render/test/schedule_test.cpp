// Every pass of every tile once, a tile's in their order, and no tile waits for another.
#include "host/render/schedule.h"

#include <gtest/gtest.h>

#include <random>

namespace raygate {
namespace {

TEST(Schedule, EveryPassOfEveryTileInTheTilesOrder) {
  constexpr int kTiles = 7, kPasses = 5;
  Schedule schedule(kTiles, kPasses);
  std::vector<int> passes(kTiles, 0);
  std::vector<Schedule::Step> at_work;
  std::mt19937 random(3);
  while (!schedule.all_ended()) {
    const auto step = at_work.size() < 3 ? schedule.begin() : std::nullopt;
    if (step) {
      EXPECT_EQ(step->pass, passes[static_cast<std::size_t>(step->tile)]++);
      for (const auto& other : at_work) EXPECT_NE(other.tile, step->tile);
      at_work.push_back(*step);
    } else {
      ASSERT_FALSE(at_work.empty());
      std::swap(at_work[random() % at_work.size()], at_work.back());
      schedule.end(at_work.back().tile);
      at_work.pop_back();
    }
  }
  EXPECT_TRUE(schedule.all_begun());
  EXPECT_EQ(schedule.fraction(), 1.0);
  EXPECT_EQ(passes, std::vector<int>(kTiles, kPasses));
}

TEST(Schedule, ATileGoesOnWhileAnotherIsSlow) {
  Schedule schedule(2, 3);
  const auto slow = schedule.begin();
  for (int pass = 0; pass < 3; ++pass) {
    const auto step = schedule.begin();
    ASSERT_TRUE(step);
    EXPECT_NE(step->tile, slow->tile);
    EXPECT_EQ(step->pass, pass);
    schedule.end(step->tile);
  }
  EXPECT_FALSE(schedule.begin()) << "the slow tile's second pass before its first one's end";
  EXPECT_FALSE(schedule.all_begun());
  schedule.end(slow->tile);
  EXPECT_TRUE(schedule.begin());
}

/// A rank goes on with its own tiles, begins new ones, and takes another's where it must.
TEST(Schedule, TilesStayWithTheirRank) {
  Schedule schedule(3, 4);
  const auto expect_step = [&](int rank, int most, int tile, int pass, int end, bool moves) {
    const auto step = schedule.begin(rank, most);
    ASSERT_TRUE(step);
    EXPECT_EQ(step->tile, tile);
    EXPECT_EQ(step->pass, pass);
    EXPECT_EQ(step->end_pass, end);
    EXPECT_EQ(step->moves, moves);
  };
  expect_step(0, 1, 0, 0, 1, false);
  expect_step(7, 2, 1, 0, 2, false);
  schedule.end(0);
  schedule.end(1);
  expect_step(7, 9, 2, 0, 4, false);  // before rank 0's tile, though that waits for longer
  expect_step(7, 1, 1, 2, 3, false);
  schedule.end(1);
  EXPECT_DOUBLE_EQ(schedule.fraction(), 4.0 / 12.0);
  expect_step(7, 1, 1, 3, 4, false);
  expect_step(7, 1, 0, 1, 2, true);
  schedule.end(0);
  expect_step(7, 1, 0, 2, 3, false);
  schedule.end(0);
  expect_step(0, 9, 0, 3, 4, true);
  EXPECT_EQ(schedule.left(), 0);
  for (const int tile : {0, 1, 2}) schedule.end(tile);
  EXPECT_TRUE(schedule.all_ended());
}

/// What an earlier run has left is with rank 0.
TEST(Schedule, ABegunPictureIsWithRank0) {
  Schedule schedule(2, 1, true);
  EXPECT_FALSE(schedule.begin(0)->moves);
  EXPECT_TRUE(schedule.begin(1)->moves);
}

/// 8192 x 8192 pixels and 2^20 samples: 2^32 steps.
TEST(Schedule, CountsBeyond32Bits) {
  Schedule schedule(1 << 14, 1 << 18);
  EXPECT_FALSE(schedule.all_begun());
  const auto step = schedule.begin();
  ASSERT_TRUE(step);
  schedule.end(step->tile);
  EXPECT_FALSE(schedule.all_ended());
  EXPECT_EQ(schedule.fraction(), 0x1p-32);
}

}  // namespace
}  // namespace raygate
