// Energy conservation: no light is created, and surfaces that absorb nothing lose none.
#include <gtest/gtest.h>

#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using enum IntegratorKind;

// White objects in a white world are invisible: surfaces that absorb nothing return all light.
TEST(Furnace, WhiteThingsInAWhiteWorld) {
  Material clear = glass(1.5f), thin = glass(1.0f), coated = matte(glm::vec3(1.0f));
  thin.illumination_model = 4;
  thin.specular = glm::vec3(0.3f);
  coated.illumination_model = 3;
  coated.specular = glm::vec3(0.5f);
  for (const Material& material : {matte(glm::vec3(1.0f)), mirror(1.0f), clear, thin, coated}) {
    Scene scene;
    add(scene, sphere(2), material);
    scene.background = glm::vec3(1.0f);
    const Camera camera = camera_at({0, 0, 4}, {0, 0, 0}, 30.0);
    const Film film = film_of(scene, camera, light(kPath, 24, 24, 4));
    int covered = 0, dark = 0;
    for (const glm::vec4& colour : film.color) {
      covered += colour.a > 0.0f;
      ASSERT_LE(colour.g, 1.00001f) << "illum " << material.illumination_model;
      dark += colour.g < 0.99999f;
    }
    EXPECT_GT(covered, 250);
    // Total reflection between the flat faces of the glass traps a few rays.
    EXPECT_LE(dark, material.illumination_model == 7 ? covered / 20 : 0)
        << "illum " << material.illumination_model;
  }
}

// For any roughness, also of glass, light is lost only at the maximum depth, and never made.
TEST(Furnace, WhiteFacetsInAWhiteWorld) {
  struct Case {
    float metallic, roughness, transmission, least;
  };
  for (const Case& c : {Case{1, 0, 0, 0.999f},
                        {1, 0.3f, 0, 0.99f},
                        {1, 1, 0, 0.99f},
                        {0, 0, 0, 0.999f},
                        {0, 0.5f, 0, 0.99f},
                        {0.5f, 0.5f, 0, 0.99f},
                        {0, 0.2f, 1, 0.98f},
                        {0, 1, 1, 0.98f},
                        {0, 0.5f, 0.5f, 0.98f}}) {
    Scene scene;
    add(scene, sphere(2), facets(c.metallic, c.roughness, c.transmission));
    scene.background = glm::vec3(1.0f);
    const Camera camera = camera_at({0, 0, 4}, {0, 0, 0}, 30.0);
    for (const IntegratorKind integrator : {kPath, kWhitted}) {
      const Film film = film_of(scene, camera, light(integrator, 24, 24, 16));
      const glm::dvec3 mean = mean_colour(film);
      EXPECT_LE(mean.g, 1.002) << c.metallic << " " << c.roughness << " " << c.transmission;
      // Whitted's rays end after four surfaces, some of them inside the glass.
      const bool ends = integrator == kWhitted && c.transmission > 0.0f;
      EXPECT_GE(mean.g, ends ? std::min(c.least, 0.93f) : c.least)
          << c.metallic << " " << c.roughness << " " << c.transmission;
    }
  }
}

// In a closed room whose walls emit 1 and reflect a fraction r, the radiance is 1 / (1 - r).
TEST(Furnace, AClosedRoomAddsUpTheGeometricSeries) {
  Material wall = matte(glm::vec3(0.5f, 0.25f, 0.75f));
  wall.emission = glm::vec3(1.0f);
  Scene scene;
  add(scene, box(glm::vec3(-1), glm::vec3(1)), wall);
  const Camera camera = camera_at({0.1, 0.2, 0.3}, {1, 0.4, 0.2}, 90.0);
  const glm::dvec3 mean = mean_colour(film_of(scene, camera, light(kPath, 32, 32, 64)));
  EXPECT_NEAR(mean.r, 2.0, 0.01);
  EXPECT_NEAR(mean.g, 4.0 / 3.0, 0.005);
  EXPECT_NEAR(mean.b, 4.0, 0.05);
}

// In a white world, no mix of materials is brighter than the world.
TEST(Furnace, EnergyIsNeverMade) {
  for (const float specular : {0.2f, 1.0f}) {
    for (int model = 1; model <= 9; ++model) {
      Material material = matte(glm::vec3(0.9f));
      material.specular = glm::vec3(specular);
      material.shininess = 12.0f;
      material.refraction_index = 1.4f;
      material.opacity = 0.6f;
      material.illumination_model = model;
      Scene scene;
      add(scene, sphere(1), material);
      add(scene, rectangle({-3, -1.2f, -3}, {6, 0, 0}, {0, 0, 6}), material);
      scene.background = glm::vec3(1.0f);
      const Camera camera = camera_at({0, 2, 4}, {0, -0.5, 0}, 40.0);
      const glm::dvec3 mean = mean_colour(film_of(scene, camera, light(kPath, 20, 20, 16)));
      EXPECT_LE(mean.r, 1.005) << "illum " << model << ", Ks " << specular;
      EXPECT_GT(mean.r, 0.2);
    }
  }
}

}  // namespace
}  // namespace raygate
