#include <gtest/gtest.h>

#include <cmath>

#include "host/base/test/temp_folder.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

Scene load(std::string_view text, std::optional<double> smooth = {}) {
  const TempFolder folder;
  return load_scene(folder.write("scene.obj", text), {.smooth = smooth});
}

glm::vec3 normal(const Scene& scene, std::size_t triangle, std::size_t corner) {
  const std::uint32_t number = scene.triangles[triangle].normals[corner];
  return number == kNoIndex ? glm::vec3(0.0f) : scene.normals[number];
}

void expect_normal_near(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-6f) << a.x << " " << a.y << " " << a.z;
}

/// Two squares at a right angle that share an edge: one faces +z, the other +x.
constexpr std::string_view kCorner = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\n";

TEST(SmoothNormals, AreThoseOfSmoothingGroups) {
  for (const char* s : {"s 3\n", "s on\n"}) {
    const Scene scene = load(std::string(kCorner) + s + "f 1 2 3 4\nf 2 5 6 3\n");
    const glm::vec3 between(std::sqrt(0.5f), 0.0f, std::sqrt(0.5f));
    expect_normal_near(normal(scene, 0, 0), {0, 0, 1});
    expect_normal_near(normal(scene, 0, 1), between);
    expect_normal_near(normal(scene, 0, 2), between);
    expect_normal_near(normal(scene, 2, 0), between);
    expect_normal_near(normal(scene, 2, 1), {1, 0, 0});
  }
}

TEST(SmoothNormals, EndWhereTheirGroupDoes) {
  for (const char* s : {"", "s off\n", "s 0\n", "s\n"}) {
    const Scene scene = load(std::string(kCorner) + s + "f 1 2 3 4\nf 2 5 6 3\n");
    for (const Triangle& triangle : scene.triangles) EXPECT_EQ(triangle.normals[0], kNoIndex);
  }
  const Scene scene = load(std::string(kCorner) + "s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
  expect_normal_near(normal(scene, 0, 1), {0, 0, 1});
  expect_normal_near(normal(scene, 2, 0), {1, 0, 0});
  EXPECT_EQ(load(std::string(kCorner) + "s much\nf 1 2 3\n").warnings.size(), 1u);
}

TEST(SmoothNormals, LeaveNormalsOfTheFileAlone) {
  const Scene scene =
      load(std::string(kCorner) + "vn 0 1 0\ns 1\nf 1//1 2//1 3//1 4//1\nf 2 5 6 3\n", 180.0);
  expect_normal_near(normal(scene, 0, 1), {0, 1, 0});
  expect_normal_near(normal(scene, 2, 0), {1, 0, 0});
}

TEST(SmoothNormals, FollowTheAngle) {
  const std::string text = std::string(kCorner) + "s 1\nf 1 2 3 4\nf 2 5 6 3\n";
  expect_normal_near(normal(load(text, 89.9), 0, 1), {0, 0, 1});
  EXPECT_GT(normal(load(text, 90.0), 0, 1).x, 0.7f);
  EXPECT_EQ(load(text, 0.0).triangles.size(), 4u);
}

TEST(SmoothNormals, JoinVerticesAtOnePlace) {
  // As in STL files, each facet has its own corners.
  const Scene scene =
      load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 -1\nv 0 1 -0\nf 1 2 3\nf 4 5 6\n", 130.0);
  EXPECT_EQ(scene.triangles[0].normals[1], scene.triangles[1].normals[0]);
  EXPECT_EQ(scene.triangles[0].normals[2], scene.triangles[1].normals[2]);
  EXPECT_NE(scene.triangles[0].normals[0], scene.triangles[1].normals[1]);
}

TEST(SmoothNormals, AreExactOnAnOctahedron) {
  const Scene scene = load(
      "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n",
      180.0);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      expect_normal_near(normal(scene, i, k), scene.positions[scene.triangles[i].vertices[k]]);
    }
  }
}

TEST(SmoothNormals, EdgesOfThreeFacesAndOfTurnedOnesAreSharp) {
  const std::string fin = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 0 0\nv 0 1 0\n";
  const Scene three = load(fin + "f 1 2 3\nf 2 1 4\nf 1 2 5\n", 180.0);
  const Scene turned = load(fin + "f 1 2 3\nf 1 2 4\n", 180.0);
  for (const Scene& scene : {three, turned}) {
    for (const Triangle& triangle : scene.triangles) EXPECT_EQ(triangle.normals[0], kNoIndex);
  }
}

}  // namespace
}  // namespace raygate
