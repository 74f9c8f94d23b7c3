#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/light/environment.h"
#include "host/light/lights.h"
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

TEST(DefaultLights, AreOneLightAboveTheCameraAndAStudio) {
  const auto lights = default_lights(square(matte(glm::vec3(0.5f))), camera_from({0, 0, 5}));
  ASSERT_TRUE(lights && lights->points.size() == 1);
  EXPECT_LT(lights->points[0].position.x, 0.0f);
  EXPECT_GT(lights->points[0].position.y, 0.0f);
  EXPECT_GT(lights->points[0].position.z, 0.0f);
  EXPECT_NE(lights->background, glm::vec3(0.0f));
  // What mirrors show of it is not one colour; its mean is what the camera sees.
  ASSERT_TRUE(lights->studio);
  const auto [least, most] = std::ranges::minmax(lights->studio->texels, {},
                                                 [](const glm::vec3& texel) { return texel.g; });
  EXPECT_GT(most.g, 10.0f * least.g);
  const glm::dvec3 mean = Environment(*lights->studio, false).mean_radiance();
  EXPECT_LT(glm::length(mean - glm::dvec3(lights->background)), 1e-3);
}

// Sixteen times the size of such a scene is beyond the range of float.
TEST(DefaultLights, StayInTheRangeOfTreesAndPredicates) {
  Scene scene;
  add(scene, rectangle({-8e37f, -8e37f, 0}, {1.6e38f, 0, 0}, {0, 1.6e38f, 0}),
      matte(glm::vec3(0.5f)));
  const auto lights = preview_lights(scene, camera_from({0, 0, 3e38}));
  ASSERT_FALSE(lights->points.empty());
  for (const PointLight& light : lights->points) {
    EXPECT_LE(largest(light.position), kMostCoordinate);
  }
}

// Whatever faces the camera, and is white, is not clipped; by paths next to nothing is.
TEST(DefaultLights, LeaveWhiteBelowOne) {
  Scene scene;
  add(scene, test::sphere(4), matte(glm::vec3(1.0f)));
  for (const double side : {-3.0, 0.0, 3.0}) {
    const Camera camera = camera_from({side, 1.5, 4});
    for (const bool is_first_look : {false, true}) {
      RenderSettings options = test::light(IntegratorKind::kWhitted, 32, 32, 1);
      const auto lights =
          is_first_look ? preview_lights(scene, camera) : default_lights(scene, camera);
      float most = 0.0f;
      for (const glm::vec4& color : test::film_of(scene, camera, options, lights).color) {
        most = std::max({most, color.r, color.g, color.b});
      }
      EXPECT_LE(most, 1.0f);
      EXPECT_GT(most, 0.7f);
      if (!is_first_look) continue;
      options.integrator = IntegratorKind::kPath;
      options.samples = 512;  // what is left is the mean
      const Film film = test::film_of(scene, camera, options, lights);
      EXPECT_LT(std::ranges::count_if(film.color, [](const auto& color) { return color.b > 1.0f; }),
                10);
    }
  }
}

TEST(PreviewLights, AreTwoLightsAndTheBackground) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  scene.background = kBlue;
  const auto lights = preview_lights(scene, camera_from({0, 0, -5}));
  ASSERT_TRUE(lights && lights->points.size() == 2);
  EXPECT_EQ(lights->background, kBlue);
  // Seen from behind, left is +x; the lights are on the camera's side.
  EXPECT_GT(lights->points[0].position.x, 0.0f);
  EXPECT_LT(lights->points[1].position.x, 0.0f);
  for (const PointLight& light : lights->points) EXPECT_LT(light.position.z, 0.0f);
  EXPECT_GT(lights->points[0].intensity.x, lights->points[1].intensity.x);
}

// Under the edge of a roof, a floor gets as much light as it sees of a ball's disc: a segment.
TEST(DefaultLights, CastSoftShadows) {
  const Scene wall = square(matte(glm::vec3(0.5f)));
  EXPECT_GT(default_lights(wall, camera_from({0, 0, 5}))->radius, 0.0);
  EXPECT_GT(preview_lights(wall, camera_from({0, 0, 5}))->radius, 0.0);
  const auto floor_at = [](double x, IntegratorKind integrator, bool has_roof) {
    Scene scene;
    add(scene, rectangle({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}), matte(glm::vec3(0.5f)));
    if (has_roof) add(scene, rectangle({0, 1, -9}, {0, 0, 18}, {9, 0, 0}), matte(glm::vec3(0.0f)));
    const Camera camera = Camera::look_at({x - 1, 0.5, 0.1}, {x, 0, 0}, {0, 1, 0}, 1e-3, 1.0);
    RenderSettings options = test::light(integrator, 1, 1, 4096);
    options.ambient = 0.0;
    options.max_depth = 1;
    const CameraLights lights{{{{0, 101, 0}, glm::dvec3(1e4)}}, glm::vec3(0.0f), {}, 10.0};
    return double(test::film_of(scene, camera, options, lights).color[0].r);
  };
  for (const IntegratorKind integrator : {IntegratorKind::kWhitted, IntegratorKind::kPath}) {
    for (const double part : {-0.8, -0.5, 0.0, 0.5}) {
      // A line from there by the edge, at (0, 1), meets the disc that far from its middle.
      const double x = -part * 10.0 / 100.0;
      const double seen =
          1.0 - (std::acos(part) - part * std::sqrt(1.0 - part * part)) / std::numbers::pi;
      EXPECT_NEAR(floor_at(x, integrator, true) / floor_at(x, integrator, false), seen, 0.01)
          << part;
    }
  }
}

// Who gives a camera gives the light of what glows; a picture that glows faintly is no light, one
// that is bright is.
TEST(DefaultLights, AreThoseOfScenesThatNothingLights) {
  const auto expect = [](const Scene& scene, bool by_default, bool in_preview, const char* what) {
    EXPECT_EQ(default_lights(scene, camera_from({0, 0, 5})).has_value(), by_default) << what;
    const auto lights = preview_lights(scene, camera_from({0, 0, 5}));
    EXPECT_EQ(lights.has_value(), in_preview) << what;
    EXPECT_TRUE(!lights || lights->points.size() == 2) << what;
  };
  expect(square(emitter(glm::vec3(1.0f))), false, false, "a light");
  Scene scene = square(matte(glm::vec3(0.5f)));
  expect(scene, true, true, "dark");
  scene.background = kBlue;
  expect(scene, false, true, "outdoors");
  scene = square(matte(glm::vec3(0.5f)));
  add(scene, rectangle({0, 0, 0.1f}, {0.1f, 0, 0}, {0, 0.1f, 0}), emitter(glm::vec3(1.0f)));
  expect(scene, false, true, "a label that glows");
  scene = square(matte(glm::vec3(0.5f)));
  Material screen = emitter(glm::vec3(1.0f));
  screen.emission_map.texture = 0;
  scene.textures.emplace_back(1, 1, std::vector<Texture::Texel>{{10, 10, 10}});
  add(scene, rectangle({-1, -1, 0.1f}, {2, 0, 0}, {0, 2, 0}), screen);
  expect(scene, true, true, "a faint picture");
  scene.textures[0] = Texture(1, 1, {{255, 255, 255}});
  expect(scene, false, false, "a bright picture");
}

TEST(PreviewLights, StandAtACameraWithinTheScene) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  add(scene, rectangle({-1, -1, 4}, {2, 0, 0}, {0, 2, 0}), matte(glm::vec3(0.5f)));
  const auto lights = preview_lights(scene, camera_from({0, 0, 2}));
  ASSERT_TRUE(lights && lights->points.size() == 1);
  EXPECT_EQ(lights->points[0].position, glm::vec3(0, 0, 2));
}

}  // namespace
}  // namespace raygate
