// The tree holds every triangle once, in boxes that hold it, at a bounded depth.
#include "host/tree/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "host/exact/test/meshes.h"
#include "host/tree/binary_tree.h"

namespace raygate {
namespace {

using test::Random;

/// Walks the whole tree; counts visits of slots, fails on anything outside its box.
struct Walk {
  const Bvh& bvh;
  std::vector<int> visits = std::vector<int>(bvh.slot_count());
  std::vector<int> node_visits = std::vector<int>(bvh.nodes().size());
  int deepest = 0;

  void check_leaf(const Bvh::Child& leaf, const glm::vec3& low, const glm::vec3& high) {
    ASSERT_LE(leaf.count, Bvh::kMaxLeafSize);
    ASSERT_LE(leaf.first + leaf.count, bvh.slot_count());
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      ++visits[leaf.first + i];
      const Corners corners = bvh.corners_of(leaf.first + i);
      Bvh::LeafRoom room;
      for (std::uint32_t v = 0; v < 3; ++v) {
        ASSERT_TRUE(glm::all(glm::lessThan(low, corners[v])));
        ASSERT_TRUE(glm::all(glm::lessThan(corners[v], high)));
        for (std::uint32_t k = 0; k < 3; ++k) {
          ASSERT_EQ(bvh.corners_of(leaf, room)[(3 * v + k) * leaf.count + i], corners[v][k]);
        }
      }
    }
  }

  void check(std::uint32_t index, const glm::vec3& low, const glm::vec3& high, int depth) {
    ASSERT_LT(index, bvh.nodes().size());
    ++node_visits[index];
    deepest = std::max(deepest, depth);
    const Bvh::Node& node = bvh.nodes()[index];
    bool absent = false;  // from here on
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
      if (node.child[i].count == 0) {
        check(node.child[i].first, child_low, child_high, depth + 1);
      } else {
        check_leaf(node.child[i], child_low, child_high);
      }
    }
  }
};

const glm::vec3 kInfinity(std::numeric_limits<float>::infinity());

void expect_sound(const std::vector<Corners>& triangles) {
  const Bvh bvh(test::scene_of(triangles), 2);
  ASSERT_EQ(bvh.slot_count(), triangles.size());
  Walk walk{bvh};
  walk.check(0, -kInfinity, kInfinity, 1);
  EXPECT_LE(walk.deepest, Bvh::kMaxDepth);
  EXPECT_TRUE(std::ranges::all_of(walk.visits, [](int n) { return n == 1; }));
  EXPECT_TRUE(std::ranges::all_of(walk.node_visits, [](int n) { return n == 1; }));
  std::vector<bool> seen(triangles.size());
  for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
    seen[bvh.triangle_of(slot)] = true;
    EXPECT_EQ(bvh.corners_of(slot), triangles[bvh.triangle_of(slot)]);
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](bool b) { return b; }));
}

std::vector<Corners> soup(Random& random, int count, float size = 1.0f) {
  std::vector<Corners> triangles;
  for (int i = 0; i < count; ++i) {
    triangles.push_back({random.point(size), random.point(size), random.point(size)});
  }
  return triangles;
}

TEST(Bvh, HoldsEveryTriangleOnce) {
  Random random;
  for (int count = 0; count < 40; ++count) expect_sound(soup(random, count));
  expect_sound(soup(random, 20000));
  expect_sound(test::box(glm::vec3(-1), glm::vec3(1)));
  expect_sound(test::sphere(5));
}

TEST(Bvh, HoldsTrianglesOfAnySize) {
  Random random;
  for (const float size : {1e-45f, 1e-43f, 1e-38f, 1e-19f, 1e19f, 1e30f, 0x1p126f}) {
    expect_sound(soup(random, 300, size));
  }
  std::vector<Corners> mixed;
  for (int exponent = -149; exponent <= 126; ++exponent) {
    mixed.push_back({glm::vec3(0.0f), random.point(std::ldexp(1.0f, exponent)),
                     random.point(std::ldexp(1.0f, exponent))});
  }
  expect_sound(mixed);
}

// Points, lines, and triangles in one plane: boxes without a size of their own.
TEST(Bvh, HoldsTrianglesWithoutAnArea) {
  Random random;
  std::vector<Corners> flat(1, {glm::vec3(0.0f), glm::vec3(-0.0f), glm::vec3(0.0f)});
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 p = random.point(), q = random.point();
    flat.push_back({p, p, p});
    flat.push_back({p, q, p});
    flat.push_back({glm::vec3(p.x, 0.0f, q.z), glm::vec3(p.y, 0.0f, q.x), glm::vec3(0.0f)});
  }
  expect_sound(flat);
}

TEST(Bvh, HoldsTrianglesThatNoSplitTellsApart) {
  const Corners one = {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  for (const std::size_t count : {2, 3, 5, 9, 1000, 300000}) {
    expect_sound(std::vector<Corners>(count, one));
  }
}

int depth_below(const BinaryTree& tree, BinaryTree::Ref ref) {
  if (tree.is_leaf(ref)) return 0;
  const auto [left, right] = tree.nodes[ref].child;
  return 1 + std::max(depth_below(tree, left), depth_below(tree, right));
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
  const Scene scene = test::scene_of(shrinking);
  const BinaryTree tree({scene.positions, scene.triangles}, Bvh::kMaxDepth, 1);
  const int depth = depth_below(tree, tree.root());
  EXPECT_LE(depth, Bvh::kMaxDepth);
  EXPECT_GT(depth, Bvh::kMaxDepth - 4);  // it would be deeper
}

bool same_bytes(const Bvh& a, const Bvh& b) {
  if (a.nodes().size() != b.nodes().size() || a.slot_count() != b.slot_count()) return false;
  for (std::uint32_t slot = 0; slot < a.slot_count(); ++slot) {
    if (a.triangle_of(slot) != b.triangle_of(slot)) return false;
  }
  return std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size_bytes()) == 0;
}

TEST(Bvh, IsTheSameWhateverTheThreadsAndVectors) {
  Random random;
  const Corners one = {glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  for (const auto& mesh :
       {test::sphere(6), soup(random, 50000), std::vector<Corners>(30000, one)}) {
    const Scene scene = test::scene_of(mesh);
    const Bvh bvh(scene);
    for (const int threads : {2, 3, 8}) EXPECT_TRUE(same_bytes(bvh, Bvh(scene, threads)));
    for (const Vectors vectors : machine_vectors()) {
      const UsingVectors in_use(vectors);
      EXPECT_TRUE(same_bytes(bvh, Bvh(scene))) << name_of(vectors);
    }
    const Scene other = test::scene_of({mesh.begin() + 1, mesh.end()});
    EXPECT_FALSE(same_bytes(bvh, Bvh(other)));
  }
}

}  // namespace
}  // namespace raygate
