// The tree holds every triangle once, in boxes that hold it, at a bounded depth.
#include "host/tree/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

using test::Random;

/// Walks the whole tree; counts visits of slots, fails on anything outside its box.
struct Walk {
  const Bvh& bvh;
  std::vector<int> visits = std::vector<int>(bvh.slot_count());
  int deepest = 0;

  void check(Bvh::Ref ref, const glm::vec3& low, const glm::vec3& high, int depth) {
    deepest = std::max(deepest, depth);
    for (std::uint32_t slot = ref.first; slot < ref.first + ref.count; ++slot) {
      ++visits[slot];
      for (const glm::vec3& v : bvh.corners_of(slot)) {
        ASSERT_TRUE(glm::all(glm::lessThan(low, v)) && glm::all(glm::lessThan(v, high)));
      }
    }
    if (ref.count != 0) return;
    const Bvh::Node& node = bvh.nodes()[ref.first];
    for (int side = 0; side < 2; ++side) {
      if (node.bounds[0][side].x > node.bounds[1][side].x) continue;  // absent
      check(node.child[side], node.bounds[0][side], node.bounds[1][side], depth + 1);
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(node.bounds[0][side][k], low[k]);
        ASSERT_LE(node.bounds[1][side][k], high[k]);
      }
    }
  }
};

void expect_sound(const std::vector<Corners>& triangles) {
  const Bvh bvh(test::scene_of(triangles));
  ASSERT_EQ(bvh.slot_count(), triangles.size());
  const glm::vec3 infinity(std::numeric_limits<float>::infinity());
  Walk walk{bvh};
  walk.check(bvh.root(), -infinity, infinity, 0);
  EXPECT_LE(walk.deepest, Bvh::kMaxDepth);
  EXPECT_TRUE(std::ranges::all_of(walk.visits, [](int n) { return n == 1; }));
  std::vector<bool> seen(triangles.size());
  for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
    seen[bvh.triangle_of(slot)] = true;
    EXPECT_EQ(bvh.corners_of(slot), triangles[bvh.triangle_of(slot)]);
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](bool b) { return b; }));
}

TEST(Bvh, HoldsEveryTriangleOnce) {
  Random random;
  expect_sound({});
  for (int count : {1, 2, 4, 5, 1000}) {
    std::vector<Corners> soup;
    for (int i = 0; i < count; ++i)
      soup.push_back({random.point(), random.point(), random.point()});
    expect_sound(soup);
  }
  expect_sound(test::box(glm::vec3(-1), glm::vec3(1)));
  expect_sound(test::sphere(4));
}

TEST(Bvh, HoldsTrianglesThatNoSplitTellsApart) {
  const Corners one = {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  expect_sound(std::vector<Corners>(1000, one));
}

// Each triangle a fraction of the size of the one before: the heuristic splits off one at a time.
TEST(Bvh, DepthIsBounded) {
  std::vector<Corners> shrinking;
  for (int i = 0; i < 240; ++i) {
    const float s = std::ldexp(1.0f, 120 - i);
    for (int k = 0; k < 4; ++k) {
      shrinking.push_back({glm::vec3(s), glm::vec3(s, 1.5f * s, s), glm::vec3(s, s, 1.5f * s)});
    }
  }
  expect_sound(shrinking);
}

}  // namespace
}  // namespace raygate
