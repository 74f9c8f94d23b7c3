#include "host/light/default_lights.h"

#include <gtest/gtest.h>

#include "host/light/test/light_scenes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::add, test::emitter, test::matte, test::rectangle;

constexpr glm::vec3 kBlue(0.1f, 0.2f, 0.4f);

Scene square(const Material& material) {
  Scene scene;
  add(scene, rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
  return scene;
}

Camera camera_from(const glm::dvec3& eye) {
  return Camera::look_at(eye, glm::dvec3(0.0), {0, 1, 0}, 35.0, 1.0);
}

TEST(AddDefaultLights, AddsOneLightAboveTheCameraAndASky) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  add_default_lights(scene, camera_from({0, 0, 5}));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_LT(scene.lights[0].position.x, 0.0f);
  EXPECT_GT(scene.lights[0].position.y, 0.0f);
  EXPECT_GT(scene.lights[0].position.z, 0.0f);
  EXPECT_NE(scene.background, glm::vec3(0.0f));
}

TEST(AddDefaultLights, LeavesWhatIsNotDarkAlone) {
  Scene lit = square(emitter(glm::vec3(1.0f)));
  add_default_lights(lit, camera_from({0, 0, 5}));
  add_preview_lights(lit, camera_from({0, 0, 5}));
  EXPECT_TRUE(lit.lights.empty());
  EXPECT_EQ(lit.background, glm::vec3(0.0f));
  Scene outdoors = square(matte(glm::vec3(0.5f)));
  outdoors.background = kBlue;
  add_default_lights(outdoors, camera_from({0, 0, 5}));
  EXPECT_TRUE(outdoors.lights.empty());
}

TEST(AddPreviewLights, AddsTwoLightsAndKeepsTheBackground) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  scene.background = kBlue;
  add_preview_lights(scene, camera_from({0, 0, -5}));
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.background, kBlue);
  // Seen from behind, left is +x; the lights are on the camera's side.
  EXPECT_GT(scene.lights[0].position.x, 0.0f);
  EXPECT_LT(scene.lights[1].position.x, 0.0f);
  for (const PointLight& light : scene.lights) EXPECT_LT(light.position.z, 0.0f);
  EXPECT_GT(scene.lights[0].intensity.x, scene.lights[1].intensity.x);
}

TEST(AddPreviewLights, TakesALabelThatGlowsForNoLight) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  add(scene, rectangle({0, 0, 0.1f}, {0.1f, 0, 0}, {0, 0.1f, 0}), emitter(glm::vec3(1.0f)));
  add_default_lights(scene, camera_from({0, 0, 5}));
  EXPECT_TRUE(scene.lights.empty()) << "who gives a camera gives the light";
  add_preview_lights(scene, camera_from({0, 0, 5}));
  EXPECT_EQ(scene.lights.size(), 2u);
}

TEST(AddPreviewLights, StandsAtACameraWithinTheScene) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  add(scene, rectangle({-1, -1, 4}, {2, 0, 0}, {0, 2, 0}), matte(glm::vec3(0.5f)));
  add_preview_lights(scene, camera_from({0, 0, 2}));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].position, glm::vec3(0, 0, 2));
}

}  // namespace
}  // namespace raygate
