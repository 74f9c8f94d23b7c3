// The tree holds every triangle once, in boxes that hold it, at a bounded depth.
#include "host/bvh/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "host/bvh/sah_builder.h"
#include "host/bvh/test/walk_bvh.h"
#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

using test::Random;

void expect_sound(const std::vector<Corners>& triangles) {
  const Bvh bvh(test::scene_of(triangles), 2);
  ASSERT_EQ(bvh.primitive_count(), triangles.size());
  const test::TreeWalk walk(bvh);
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

int depth_below(const BinaryBvh& tree, BinaryBvh::Ref ref) {
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
  const BinaryBvh tree({scene.positions, scene.triangles}, Bvh::kMaxDepth, 1);
  const int depth = depth_below(tree, tree.root());
  EXPECT_LE(depth, Bvh::kMaxDepth);
  EXPECT_GT(depth, Bvh::kMaxDepth - 4);  // it would be deeper
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
  detail::vectors_in_use = -1;  // as in a process that has not settled them yet
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

}  // namespace
}  // namespace raygate
