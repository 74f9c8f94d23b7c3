// What is below an instance is a tree like any other.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/bvh/bvh.h"
#include "host/bvh/sah_builder.h"
#include "host/bvh/test/walk_bvh.h"
#include "host/scene/test/instanced_scene.h"

namespace raygate {
namespace {

using test::Random;

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
    const test::TreeWalk walk(bvh);
    std::size_t in_leaves = 0;
    for (const Bvh::Child& leaf : bvh.leaves()) {
      for (std::uint32_t primitive = leaf.first; primitive < leaf.first + leaf.count;
           ++primitive, ++in_leaves) {
        const auto& vertices = flat.triangles[bvh.triangle_of(primitive)].vertices;
        const Corners corners = bvh.corners_of(primitive);
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

// A mesh's tree alone would be as deep as any may be; and so would the one above.
TEST(InstanceBvh, DepthIsBounded) {
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
