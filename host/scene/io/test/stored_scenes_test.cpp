// The scenes in scenes/ load without a warning and have the geometry and materials they claim.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

Scene stored(const std::string& name) { return load_obj(RAYGATE_SCENES "/" + name); }
Scene made(const std::string& name) { return load_obj(RAYGATE_MADE_SCENES "/" + name); }

// Returns the number of sides without exactly one partner in the opposite direction.
std::size_t open_sides(const Scene& scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const Triangle& triangle : scene.triangles) {
    for (int i = 0; i < 3; ++i) ++sides[{triangle.vertices[i], triangle.vertices[(i + 1) % 3]}];
  }
  std::size_t open = 0;
  for (const auto& [side, count] : sides) {
    const auto partner = sides.find({side.second, side.first});
    open += count != 1 || partner == sides.end() || partner->second != 1;
  }
  return open;
}

TEST(StoredScenes, CornellBox) {
  const Scene scene = stored("cornell.obj");
  EXPECT_TRUE(scene.warnings.empty());
  // 18 quads: floor, back, two walls, four around the light, the light, two blocks of five.
  EXPECT_EQ(scene.triangles.size(), 38u);
  EXPECT_EQ(scene.objects.size(), 8u);
  ASSERT_EQ(scene.materials.size(), 4u);
  EXPECT_EQ(scene.materials[3].emission, glm::vec3(17, 12, 4));

  // The box is seen through its opening: from in front, below the ceiling, between the walls.
  const glm::vec3 eye = front_camera(scene, 1.0).eye();
  EXPECT_GT(eye.z, 559.2f);
  EXPECT_LT(eye.y, 548.8f);
  EXPECT_NEAR(eye.x, 278.0f, 1.0f);
}

TEST(StoredScenes, PaperSize) {
  const Scene scene = stored("paper.obj");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.triangles.size(), 34u);  // from 20 polygons
  EXPECT_EQ(scene.materials.size(), 9u);
}

TEST(StoredScenes, Teapot) {
  const Scene scene = stored("teapot.obj");
  EXPECT_TRUE(scene.warnings.empty());
  // 32 patches of 8 x 8 quads, less one triangle at each of 4 x 8 steps around two poles.
  EXPECT_EQ(scene.triangles.size(), 32u * 128 - 2 * 4 * 8);
  EXPECT_EQ(scene.objects.size(), 10u);
  for (const Triangle& triangle : scene.triangles) {
    const auto position = [&](int i) { return scene.positions[triangle.vertices[i]]; };
    const glm::vec3 across = glm::cross(position(1) - position(0), position(2) - position(0));
    for (const std::uint32_t normal : triangle.normals) {
      ASSERT_NE(normal, kNoIndex);
      EXPECT_GT(glm::dot(across, scene.normals[normal]), 0.0f) << "the normals face outwards";
    }
  }
}

TEST(StoredScenes, SphereIsClosed) {
  const Scene scene = made("sphere.obj");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.triangles.size(), 81920u);
  EXPECT_EQ(open_sides(scene), 0u);
  for (const glm::vec3& position : scene.positions) {
    EXPECT_NEAR(glm::length(position), 1.0f, 1e-6f);
  }
}

TEST(StoredScenes, SceneFilesAndTheirObjsGoTogether) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(RAYGATE_SCENES)) {
    if (entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path());
    SceneFile file = read_scene_file(entry.path());
    // Generated scenes are in the build folder.
    if (file.obj.parent_path() != entry.path().parent_path()) {
      file.obj = RAYGATE_MADE_SCENES / file.obj.filename();
    }
    const Scene scene = load_scene(file);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_TRUE(file.camera.camera);
    const bool shines = std::ranges::any_of(scene.materials, [](const Material& material) {
      return material.emission != glm::vec3(0.0f);
    });
    EXPECT_TRUE(shines || !scene.lights.empty());
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(StoredScenes, SphereflakeIsLarge) {
  const Scene scene = made("sphereflake.obj");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.triangles.size(), 820u * 320 + 2);
  EXPECT_EQ(open_sides(scene), 4u) << "of the floor";
}

}  // namespace
}  // namespace raygate
