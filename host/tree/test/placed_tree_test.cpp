// What is below an instance is a tree like any other.
#include "host/tree/placed_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/scene/test/instanced_scene.h"
#include "host/tree/bvh.h"
#include "host/tree/runs.h"

namespace raygate {
namespace {

using test::Random;

TEST(Runs, FindWhatEachNumberIsIn) {
  for (const std::vector<std::uint32_t>& lengths :
       {std::vector<std::uint32_t>{1}, {5, 5, 5}, {1, 1, 1000, 1, 1, 1, 3}, {100000, 1, 2}}) {
    const Runs runs(17, lengths);
    std::uint32_t number = 17;
    for (std::uint32_t run = 0; run < lengths.size(); ++run) {
      EXPECT_EQ(runs.begin(run), number);
      for (std::uint32_t i = 0; i < lengths[run]; ++i) ASSERT_EQ(runs.find(number++), run);
    }
    EXPECT_EQ(runs.end(), number);
  }
}

/// Walks the whole tree; fails on a corner that is not strictly inside its boxes.
struct Walk {
  const Bvh& bvh;
  std::vector<int> visits;  // of triangles
  int deepest = 0;

  explicit Walk(const Bvh& tree) : bvh(tree), visits(tree.triangle_count()) {}

  void check_leaf(const Bvh::Child& leaf, const glm::vec3& low, const glm::vec3& high) {
    ASSERT_LE(leaf.count, Bvh::kMaxLeafSize);
    Bvh::LeafRoom room;
    const float* const from = bvh.corners_of(leaf, room);
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t slot = leaf.first + i;
      ++visits[bvh.triangle_of(slot)];
      const Corners corners = bvh.corners_of(slot);
      for (std::uint32_t v = 0; v < 3; ++v) {
        ASSERT_TRUE(glm::all(glm::lessThan(low, corners[v])));
        ASSERT_TRUE(glm::all(glm::lessThan(corners[v], high)));
        for (std::uint32_t k = 0; k < 3; ++k) {
          ASSERT_EQ(from[(3 * v + k) * leaf.count + i], corners[v][k]);
        }
      }
    }
  }

  void check(std::uint32_t index, const glm::vec3& low, const glm::vec3& high, int depth = 1) {
    deepest = std::max(deepest, depth);
    Bvh::Node room;
    const Bvh::Node& node = bvh.node(index, room);
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
      const Bvh::Child child = bvh.child_of(index, i);
      ASSERT_EQ(child.first, node.child[i].first);
      ASSERT_EQ(child.count, node.child[i].count);
      if (child.count == 0) {
        check(child.first, child_low, child_high, depth + 1);
      } else {
        check_leaf(child, child_low, child_high);
      }
    }
  }
};

void expect_sound(const Scene& scene) {
  const Scene flat = test::written_out(scene);
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors using_vectors(vectors);
    const Bvh bvh(scene, 2);
    ASSERT_EQ(bvh.triangle_count(), flat.triangles.size());
    EXPECT_TRUE(bvh.has_instances());
    const glm::vec3 infinity(std::numeric_limits<float>::infinity());
    Walk walk(bvh);
    walk.check(0, -infinity, infinity);
    EXPECT_LE(walk.deepest, Bvh::kMaxDepth);
    EXPECT_TRUE(std::ranges::all_of(walk.visits, [](int n) { return n == 1; }));
    std::size_t in_leaves = 0;
    for (const Bvh::Child& leaf : bvh.leaves()) {
      for (std::uint32_t slot = leaf.first; slot < leaf.first + leaf.count; ++slot, ++in_leaves) {
        const auto& vertices = flat.triangles[bvh.triangle_of(slot)].vertices;
        const Corners corners = bvh.corners_of(slot);
        for (std::size_t v = 0; v < 3; ++v) ASSERT_EQ(corners[v], flat.positions[vertices[v]]);
        const StoredFace face = bvh.face_of(slot);
        EXPECT_EQ(bvh.is_placed(slot), face.instance != kNoIndex);
        EXPECT_EQ(object_at(scene, face), flat.triangles[bvh.triangle_of(slot)].object);
      }
    }
    EXPECT_EQ(in_leaves, flat.triangles.size());
  }
}

TEST(PlacedTree, HoldsEveryTriangleOnce) {
  Random random;
  Scene scene = test::instanced_scene(random, 40);
  expect_sound(scene);
  scene.triangles.clear();
  expect_sound(scene);
  scene.instances.resize(1);
  expect_sound(scene);
}

TEST(PlacedTree, HoldsTrianglesOfAnySize) {
  Random random;
  for (const float size : {0x1p-120f, 0x1p-40f, 1.0f, 0x1p60f}) {
    for (const double scale : {0x1p-160, 0x1p-30, 1.0, 0x1p40}) {
      Scene scene = test::instanced_scene(random, 30);
      for (Mesh& mesh : scene.meshes) {
        for (glm::vec3& position : mesh.positions) position *= size;
      }
      for (Instance& instance : scene.instances) {
        for (auto& row : instance.rows) {
          for (int axis = 0; axis < 3; ++axis) {
            row[axis] *= random.below(4) == 0 ? 0.0 : scale;
          }
          row[3] *= random.below(3) == 0 ? 0.0 : double(random.uniform()) * size;
        }
      }
      expect_sound(scene);
    }
  }
}

// A mesh's tree alone would be as deep as any may be; and so would the one above.
TEST(PlacedTree, DepthIsBounded) {
  std::vector<Corners> shrinking;
  for (int i = 0; i < 200; ++i) {
    const float s = std::ldexp(1.0f, 100 - i);
    for (int k = 0; k < 4; ++k) {
      shrinking.push_back({glm::vec3(s), glm::vec3(s, 1.5f * s, s), glm::vec3(s, s, 1.5f * s)});
    }
  }
  Scene scene = test::scene_of(shrinking);
  (void)add_mesh(scene, test::scene_of(shrinking));
  for (int i = 0; i < 120; ++i) {
    Instance& instance = scene.instances.emplace_back();
    for (int k = 0; k < 3; ++k) instance.rows[k][k] = std::ldexp(1.0, -i);
  }
  expect_sound(scene);
}

}  // namespace
}  // namespace raygate
