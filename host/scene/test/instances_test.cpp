// Instances of meshes, and the names of their objects.
#include "host/scene/instances.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/bounds.h"
#include "host/scene/test/instanced_scene.h"

namespace raygate {
namespace {

using test::Random;

TEST(Instances, AreWrittenOutWithTheSameNumbersAndCorners) {
  Random random;
  const Scene scene = test::instanced_scene(random, 20), flat = test::written_out(scene);
  EXPECT_TRUE(flat.instances.empty());
  ASSERT_EQ(flat.triangles.size(), triangle_count(scene));
  std::vector<Corners> corners, flat_corners;
  const auto collect = [](std::vector<Corners>& to) {
    return [&to](const Corners& triangle, const Triangle&) { to.push_back(triangle); };
  };
  for_each_face(scene, collect(corners));
  for_each_face(flat, collect(flat_corners));
  EXPECT_EQ(corners, flat_corners);
  EXPECT_EQ(corners.size(), triangle_count(scene));
}

TEST(Instances, HaveTheNormalsAndObjectsOfThoseWrittenOut) {
  Random random;
  const Scene scene = test::instanced_scene(random, 4), flat = test::written_out(scene);
  std::size_t number = scene.triangles.size();
  int smooth = 0;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    for (std::uint32_t k = 0; k < scene.meshes[instance.mesh].triangles.size(); ++k, ++number) {
      const Triangle& face = face_at(scene, {i, k});
      EXPECT_EQ(object_at(scene, {i, k}), flat.triangles[number].object);
      for (std::size_t c = 0; c < 3; ++c) {
        if (face.normals[c] == kNoIndex) continue;
        const glm::vec3 normal = transform_normal(instance, scene.normals[face.normals[c]]);
        EXPECT_EQ(normal, flat.normals[flat.triangles[number].normals[c]]);
        EXPECT_NEAR(glm::length(normal), 1.0f, 1e-6f);
        ++smooth;
      }
    }
  }
  EXPECT_EQ(number, flat.triangles.size());
  EXPECT_GT(smooth, 0);
}

TEST(Instances, NormalsStandOnWhatIsTurnedAndStretched) {
  Random random;
  const Instance instance = test::placed_at_random(random, random.point(), 2.0f);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 along = random.point(), other = random.point(), zero(0.0f);
    const glm::dvec3 normal(transform_normal(instance, glm::normalize(glm::cross(along, other))));
    const glm::dvec3 from(transform_point(instance.rows, zero));
    for (const glm::vec3& edge : {along, other}) {
      EXPECT_NEAR(glm::dot(normal, glm::dvec3(transform_point(instance.rows, edge)) - from), 0.0,
                  1e-5);
    }
  }
  Instance flat;
  flat.rows[2][2] = 0.0;
  EXPECT_EQ(transform_normal(flat, {1.0f, 0.0f, 0.0f}), glm::vec3(0.0f));
  EXPECT_EQ(transform_normal(flat, {0.0f, 0.0f, 1.0f}), glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST(Instances, BoxesAreThoseOfWhatIsWrittenOut) {
  Random random;
  Scene scene = test::instanced_scene(random, 30);
  scene.triangles.clear();
  scene.positions.clear();
  const Scene flat = test::written_out(scene);
  for (const auto box_of : {triangle_bounds, position_bounds}) {
    const Bounds3 box = box_of(scene), expected = box_of(flat);
    EXPECT_EQ(box.low, expected.low);
    EXPECT_EQ(box.high, expected.high);
  }
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Bounds3 box = transform_bounds(instance.rows, bounds_of(mesh.positions));
    for (const glm::vec3& position : mesh.positions) {
      const glm::vec3 at = transform_point(instance.rows, position);
      EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::vec3(box.low), at)));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(at, glm::vec3(box.high))));
    }
  }
}

TEST(Instances, MeshesBringWhatTheyName) {
  Scene scene = test::scene_of(test::box(glm::vec3(0), glm::vec3(1)));
  scene.normals.resize(5);
  scene.texcoords.resize(7);
  scene.materials[0].normal_map.texture = 0;
  scene.textures.push_back(Texture(1, 1, {{}}));
  Scene part = test::scene_of(test::sphere(0));
  part.normals.resize(2);
  part.texcoords.resize(2);
  part.positions.emplace_back(9.0f);  // used by no triangle
  part.textures.push_back(Texture(1, 1, {{}}));
  part.materials[0].diffuse_map.texture = 0;
  part.triangles[3].normals = {0, 1, kNoIndex};
  part.triangles[3].texcoords = {1, 0, 1};
  ASSERT_EQ(add_mesh(scene, std::move(part)), 0u);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 60u);
  const Triangle& triangle = mesh.triangles[3];
  EXPECT_EQ(triangle.normals, (std::array<std::uint32_t, 3>{5, 6, kNoIndex}));
  EXPECT_EQ(triangle.texcoords, (std::array<std::uint32_t, 3>{8, 7, 8}));
  EXPECT_EQ(triangle.material, 1u);
  EXPECT_EQ(scene.materials[1].diffuse_map.texture, 1u);
}

TEST(Instances, TurnedMeshesHaveTheirFrontOnTheOtherSide) {
  Random random;
  Scene scene = test::instanced_scene(random, 1);
  const std::uint32_t turned = add_mirrored(scene, 0);
  const Mesh &mesh = scene.meshes[0], &other = scene.meshes[turned];
  ASSERT_EQ(mesh.triangles.size(), other.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.triangles[i].vertices[k], other.triangles[i].vertices[2 - k]);
      EXPECT_EQ(scene.normals[mesh.triangles[i].normals[k]],
                -scene.normals[other.triangles[i].normals[2 - k]]);
    }
  }
}

}  // namespace
}  // namespace raygate
