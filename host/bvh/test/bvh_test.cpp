// BVHs with and without instances hold each triangle once, inside its boxes, at bounded depth.
#include "host/bvh/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "host/base/test/using_vectors.h"
#include "host/bvh/sah_builder.h"
#include "host/bvh/traversal.h"
#include "host/exact/test/meshes.h"
#include "host/scene/test/instanced_scene.h"

namespace raygate {
namespace {

using test::Random;

/// Walks a whole BVH, including instances. Fails if a corner is not strictly inside all its boxes.
struct TreeWalk {
  const Bvh& bvh;
  std::vector<int> visits;       // number of visits, by triangle
  std::vector<int> node_visits;  // number of visits, by stored node
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
      const FloatCorners corners = bvh.float_corners_of(primitive);
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

void expect_sound(const std::vector<Corners>& triangles) {
  const Bvh bvh(test::scene_of(triangles), 2);
  ASSERT_EQ(bvh.primitive_count(), triangles.size());
  const TreeWalk walk(bvh);
  std::vector<bool> seen(triangles.size());
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    seen[bvh.triangle_of(primitive)] = true;
    EXPECT_EQ(bvh.corners_of(primitive), triangles[bvh.triangle_of(primitive)]);
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

// Points, lines, and triangles in one plane have boxes without volume.
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

int depth_below(const BinaryBvh& tree, BinaryBvh::Ref ref) {
  if (tree.is_leaf(ref)) return 0;
  const auto [left, right] = tree.nodes[ref].child;
  return 1 + std::max(depth_below(tree, left), depth_below(tree, right));
}

/// Returns four triangles of each of `sizes` sizes. Each size is half the one before, so the
/// heuristic splits off one size at a time.
std::vector<Corners> shrinking(int sizes, int exponent) {
  std::vector<Corners> triangles;
  for (int i = 0; i < sizes; ++i) {
    const float s = std::ldexp(1.0f, exponent - i);
    for (int k = 0; k < 4; ++k) {
      triangles.push_back({glm::vec3(s), glm::vec3(s, 1.5f * s, s), glm::vec3(s, s, 1.5f * s)});
    }
  }
  return triangles;
}

TEST(Bvh, DepthIsBounded) {
  const std::vector<Corners> mesh = shrinking(240, 120);
  expect_sound(mesh);
  std::vector<Primitive> primitives;
  for (const auto& [a, b, c] : mesh) {
    const Box box = box_around(a, b, c);
    primitives.push_back(Primitive(box, static_cast<std::uint32_t>(primitives.size())));
  }
  const BinaryBvh tree(primitives, Bvh::kMaxDepth, 1);
  const int depth = depth_below(tree, tree.root());
  EXPECT_LE(depth, Bvh::kMaxDepth);
  EXPECT_GT(depth, Bvh::kMaxDepth - 4);  // without the bound, it would be deeper
}

TEST(Bvh, BoundsAreNotSubnormal) {
  const Bvh bvh(test::scene_of(test::sphere(4)));
  for (const Bvh::Node& node : bvh.nodes()) {
    for (const auto& corner : node.bounds) {
      for (const auto& axis : corner) {
        for (const float bound : axis) EXPECT_NE(std::fpclassify(bound), FP_SUBNORMAL);
      }
    }
  }
}

bool same_bytes(const Bvh& a, const Bvh& b) {
  if (a.nodes().size() != b.nodes().size() || a.primitive_count() != b.primitive_count())
    return false;
  for (std::uint32_t primitive = 0; primitive < a.primitive_count(); ++primitive) {
    if (a.triangle_of(primitive) != b.triangle_of(primitive)) return false;
  }
  return std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size_bytes()) == 0;
}

TEST(Bvh, WhatOneThreadThrowsEndsAll) {
  Random random;
  const Scene scene = test::scene_of(soup(random, 20000));
  const UsingVectors put_back(vectors_in_use());
  ASSERT_EQ(::setenv("RAYGATE_VECTORS", "foo", 1), 0);
  detail::vectors_in_use = -1;  // as in a process that has not selected an instruction set
  EXPECT_THROW(Bvh(scene, 2), std::runtime_error);
  ::unsetenv("RAYGATE_VECTORS");
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

TEST(RangeMap, FindWhatEachNumberIsIn) {
  for (const std::vector<std::uint32_t>& lengths :
       {std::vector<std::uint32_t>{1}, {5, 5, 5}, {1, 1, 1000, 1, 1, 1, 3}, {100000, 1, 2}}) {
    const RangeMap runs(17, lengths);
    std::uint32_t number = 17;
    for (std::uint32_t run = 0; run < lengths.size(); ++run) {
      EXPECT_EQ(runs.begin(run), number);
      for (std::uint32_t i = 0; i < lengths[run]; ++i) ASSERT_EQ(runs.find(number++), run);
    }
    EXPECT_EQ(runs.end(), number);
  }
}

void expect_sound(const Scene& scene) {
  const Scene flat = test::written_out(scene);
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors using_vectors(vectors);
    const Bvh bvh(scene, 2);
    ASSERT_EQ(bvh.triangle_count(), flat.triangles.size());
    EXPECT_TRUE(bvh.has_instances());
    const TreeWalk walk(bvh);
    std::size_t in_leaves = 0;
    std::vector<Bvh::Child> leaves;
    const auto is_present = [](const Bvh::Node& node) {
      LaneMask mask = 0;
      for (int i = 0; i < Bvh::kWidth; ++i) {
        mask |= node.bounds[0][0][i] <= node.bounds[1][0][i] ? 1u << i : 0;
      }
      return mask;
    };
    (void)any_leaf(bvh, is_present, [&](const Bvh::Child& leaf) {
      leaves.push_back(leaf);
      return false;
    });
    for (const Bvh::Child& leaf : leaves) {
      for (std::uint32_t primitive = leaf.first; primitive < leaf.first + leaf.count;
           ++primitive, ++in_leaves) {
        const auto& vertices = flat.triangles[bvh.triangle_of(primitive)].vertices;
        const FloatCorners corners = bvh.float_corners_of(primitive);
        for (std::size_t v = 0; v < 3; ++v) ASSERT_EQ(corners[v], flat.positions[vertices[v]]);
        const FaceRef face = bvh.face_of(primitive);
        EXPECT_EQ(bvh.is_instanced(primitive), face.instance != kNoIndex);
        EXPECT_EQ(object_at(scene, face), flat.triangles[bvh.triangle_of(primitive)].object);
      }
    }
    EXPECT_EQ(in_leaves, flat.triangles.size());
  }
}

TEST(InstanceBvh, HoldsEveryTriangleOnce) {
  Random random;
  Scene scene = test::instanced_scene(random, 40);
  expect_sound(scene);
  scene.triangles.clear();
  expect_sound(scene);
  scene.instances.resize(1);
  expect_sound(scene);
}

TEST(InstanceBvh, HoldsTrianglesOfAnySize) {
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

// The mesh's BVH alone would have the maximum depth, and so would the BVH above the instances.
TEST(InstanceBvh, DepthIsBounded) {
  Scene scene = test::scene_of(shrinking(200, 100));
  (void)add_mesh(scene, test::scene_of(shrinking(200, 100)));
  for (int i = 0; i < 120; ++i) {
    Instance& instance = scene.instances.emplace_back();
    for (int k = 0; k < 3; ++k) instance.rows[k][k] = std::ldexp(1.0, -i);
  }
  expect_sound(scene);
}

}  // namespace
}  // namespace raygate
