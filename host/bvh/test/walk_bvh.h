// Whether a tree holds every triangle once, in boxes that hold it, at a bounded depth.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "host/exact/exact.h"

namespace raygate::test {

/// Walks a whole tree, what is below instances, too; fails on a corner that is not strictly inside
/// its boxes.
struct TreeWalk {
  const Bvh& bvh;
  std::vector<int> visits;       // of triangles
  std::vector<int> node_visits;  // of nodes that are stored
  int deepest = 0;

  explicit TreeWalk(const Bvh& tree)
      : bvh(tree), visits(tree.triangle_count()), node_visits(tree.nodes().size()) {
    const glm::vec3 infinity(std::numeric_limits<float>::infinity());
    check(0, -infinity, infinity, 1);
    EXPECT_LE(deepest, Bvh::kMaxDepth);
    EXPECT_TRUE(std::ranges::all_of(visits, [](int n) { return n == 1; }));
    EXPECT_TRUE(std::ranges::all_of(node_visits, [](int n) { return n == 1; }));
  }

  void check_leaf(const Bvh::Child& leaf, const glm::vec3& low, const glm::vec3& high) {
    ASSERT_LE(leaf.count, Bvh::kMaxLeafSize);
    Bvh::LeafRoom room;
    const float* const from = BvhView(bvh).corners_of(leaf, room);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t primitive = leaf.first + i;
      ++visits[bvh.triangle_of(primitive)];
      const Corners corners = bvh.corners_of(primitive);
      for (std::uint32_t v = 0; v < 3; ++v) {
        ASSERT_TRUE(glm::all(glm::lessThan(low, corners[v])));
        ASSERT_TRUE(glm::all(glm::lessThan(corners[v], high)));
        for (std::uint32_t k = 0; k < 3; ++k) {
          ASSERT_EQ(from[(3 * v + k) * leaf.count + i], corners[v][k]);
        }
      }
    }
  }

  void check(std::uint32_t index, const glm::vec3& low, const glm::vec3& high, int depth) {
    deepest = std::max(deepest, depth);
    if (index < node_visits.size()) ++node_visits[index];
    Bvh::Node room;
    const Bvh::Node& node = BvhView(bvh).node(index, room);
    bool absent = false;
    for (int i = 0; i < Bvh::kWidth; ++i) {
      const auto [child_low, child_high] = node.box(i);
      absent = absent || !(child_low.x <= child_high.x);
      if (absent) {
        ASSERT_EQ(child_low, glm::vec3(std::numeric_limits<float>::infinity()));
        ASSERT_EQ(child_high, -child_low);
        continue;
      }
      ASSERT_TRUE(glm::all(glm::lessThanEqual(low, child_low)));  // false for NaN
      ASSERT_TRUE(glm::all(glm::lessThan(child_low, child_high)));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(child_high, high)));
      const Bvh::Child child = node.child[i];
      if (child.count == 0) {
        check(child.first, child_low, child_high, depth + 1);
      } else {
        check_leaf(child, child_low, child_high);
      }
    }
  }
};

}  // namespace raygate::test
