// Views in mirrors and through glass obey the laws of reflection and refraction.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using std::numbers::pi;
using enum IntegratorKind;

// A mirror shows what a camera behind it sees of the mirrored scene without the mirror.
TEST(MirrorGlass, AMirrorShowsTheMirroredScene) {
  Scene things;
  add(things, sphere(2, 0.5f, {0.3f, 0.1f, 1.5f}), matte({0.8f, 0.4f, 0.2f}));
  add(things, rectangle({-4, -1, 0.01f}, {8, 0, 0}, {0, 0, 8}), matte(glm::vec3(0.6f)));
  things.lights.push_back({{1, 3, 4}, {20, 20, 20}});
  Scene mirrored = things;
  // The mirror is in front of everything, fills the view, and blocks no light.
  add(mirrored, rectangle({-50, -1, 0}, {100, 0, 0}, {0, 100, 0}), mirror(1.0f));
  constexpr int kSize = 64;
  const Camera front = camera_at({0.5, 0.6, 4}, {0.2, 0.3, 0}, 30.0);
  const Camera behind = camera_at({0.5, 0.6, -4}, {0.2, 0.3, 0}, 30.0);
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    RenderSettings options = light(integrator, kSize, kSize, 1);
    options.max_depth = 1;
    options.ambient = 0.0;
    const Film in_mirror = film_of(mirrored, front, options);
    options.max_depth = 0;
    const Film direct = film_of(things, behind, options);
    int compared = 0, different = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const std::size_t here = std::size_t(y) * kSize + x;
        const std::size_t there = std::size_t(y) * kSize + (kSize - 1 - x);
        if (in_mirror.primitive[here] < things.triangles.size()) continue;  // seen directly
        ++compared;
        const glm::vec4 difference = glm::abs(in_mirror.color[here] - direct.color[there]);
        different += std::max({difference.r, difference.g, difference.b}) > 1e-4f;
      }
    }
    EXPECT_GT(compared, 2000);
    EXPECT_LT(different, compared / 100) << "only where an edge is hit by a hair";
  }
}

Material shown(const glm::vec3& colour) {
  Material material = matte(colour);
  material.illumination_model = 0;
  return material;
}

// A slab of glass displaces every ray by Snell's law, and each side reflects Fresnel's fraction.
// Behind the slab are a red and a green half-plane, unlit.
TEST(MirrorGlass, ASlabOfGlassShiftsWhatIsBehindIt) {
  const double index = 1.5, thickness = 1.0;
  Scene scene;
  add(scene, rectangle({-30, -30, -2}, {30, 0, 0}, {0, 60, 0}), shown({1, 0, 0}));
  add(scene, rectangle({0, -30, -2}, {30, 0, 0}, {0, 60, 0}), shown({0, 1, 0}));
  add(scene, box({-20, -20, -float(thickness)}, {20, 20, 0}), glass(float(index)));
  const Camera camera = camera_at({4, 0.3, 3}, {1, 0, 0}, 50.0);
  RenderSettings options = light(kWhitted, 80, 80, 1);
  options.max_depth = 2;  // without light reflected inside the glass
  options.threshold = 0.0;
  const Film film = film_of(scene, camera, options);
  int red = 0, green = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {
      const glm::dvec3 way =
          glm::normalize(glm::dvec3(camera.direction((x + 0.5) / 80, (y + 0.5) / 80)));
      const double sine = std::hypot(way.x, way.y), inside = sine / index;
      const double in_glass = thickness * inside / std::sqrt(1 - inside * inside);
      const double in_air = (3.0 + 2.0 - thickness) * sine / -way.z;
      const double arrives = camera.eye().x + way.x / sine * (in_air + in_glass);
      if (std::abs(arrives) < 1e-5) continue;
      const double through = 1.0 - reflectance(std::asin(sine), index);
      const glm::vec4 colour = film.color[std::size_t(y) * 80 + x];
      ASSERT_NEAR(arrives < 0.0 ? colour.r : colour.g, through * through, 1e-6) << x << " " << y;
      ASSERT_EQ(arrives < 0.0 ? colour.g : colour.r, 0.0f) << x << " " << y;
      ++(arrives < 0.0 ? red : green);
    }
  }
  EXPECT_GT(red, 500);
  EXPECT_GT(green, 500);
}

// Seen from under water, the surface is a perfect mirror of the ground beyond the critical angle;
// below that angle the sky is visible, too.
TEST(MirrorGlass, TotalReflectionShowsTheGround) {
  Scene scene;
  add(scene, rectangle({-90, -2, 90}, {180, 0, 0}, {0, 0, -180}), shown({0.5f, 0.25f, 0}));
  add(scene, rectangle({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), glass(4.0f / 3.0f));
  scene.background = glm::vec3(0, 0, 1);
  const auto seen = [&](double degrees) {
    const double angle = glm::radians(degrees);
    const Camera camera = camera_at({0, -1, 0}, {std::sin(angle), -1 + std::cos(angle), 0}, 1e-3);
    RenderSettings options = light(kWhitted, 1, 1, 1);
    options.max_depth = 1;
    options.ambient = 0.0;
    return film_of(scene, camera, options).color[0];
  };
  const double critical = glm::degrees(std::asin(0.75));
  for (const double degrees : {critical + 0.1, 60.0, 80.0}) {
    EXPECT_EQ(seen(degrees), glm::vec4(0.5f, 0.25f, 0, 1)) << degrees;
  }
  for (const double degrees : {5.0, 30.0, critical - 0.1}) {
    const double reflected = reflectance(glm::radians(degrees), 0.75);
    const glm::vec4 colour = seen(degrees);
    EXPECT_NEAR(colour.r, 0.5 * reflected, 1e-4) << degrees;
    EXPECT_NEAR(colour.b, 1.0 - reflected, 1e-4) << degrees;
  }
}

// Light passes through one or two panes that each transmit half of it.
TEST(MirrorGlass, PanesWeakenLightAndShadowsAlike) {
  float unweakened = 0.0f;
  for (int panes = 0; panes <= 2; ++panes) {
    Scene scene;
    for (int i = 0; i < panes; ++i) {
      Material pane = matte(glm::vec3(0.0f));
      pane.opacity = 0.5f;
      add(scene, rectangle({-1, 1 + 0.1f * float(i), -1}, {2, 0, 0}, {0, 0, 2}), pane);
    }
    Scene by_point = scene, by_area = scene;
    by_point.lights.push_back({{0, 2, 0}, {1, 1, 1}});
    add(by_area, rectangle({-0.1f, 2, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}), emitter(glm::vec3(9)));
    const double share = std::pow(0.5, panes), point = 1.0 / 4.0 / pi;
    EXPECT_NEAR(floor_radiance(by_point, kWhitted, 1), share * point, 1e-6);
    EXPECT_NEAR(floor_radiance(by_point, kPath, 1), share * point, 1e-6);
    const float whitted = floor_radiance(by_area, kWhitted, 256);
    if (panes == 0) unweakened = whitted;
    EXPECT_NEAR(whitted, share * unweakened, 1e-6);
    EXPECT_NEAR(floor_radiance(by_area, kPath, 256), whitted, 2e-2 * whitted);
  }
}

// A lamp covers all that a pond reflects. Most camera rays are refracted into the dark. Yet few
// samples suffice for the lamp's reflection, because EmitterSupersampler follows both directions.
TEST(MirrorGlass, ALampInAPondIsAsBrightAsFresnelSays) {
  Scene scene;
  add(scene, rectangle({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}), glass(1.5f));
  add(scene, rectangle({-20, 10, -20}, {40, 0, 0}, {0, 0, 40}), emitter(glm::vec3(10.0f)));
  const Camera camera = camera_at({0, 3, 0.3}, {0, 0, 0}, 20.0);
  RenderSettings options = light(kPath, 16, 16, 16);
  options.filter = ReconstructionFilter::kBox;
  const Film film = film_of(scene, camera, options);
  double sum = 0.0, squares = 0.0;
  for (const glm::vec4& colour : film.color) {
    sum += double{colour.x};
    squares += double{colour.x} * double{colour.x};
  }
  const double mean = sum / 256.0, deviation = std::sqrt(squares / 256.0 - mean * mean);
  EXPECT_NEAR(mean, 0.4, 0.004);  // seen nearly straight down: 4 %
  EXPECT_LT(deviation, 0.2 * mean);
}

}  // namespace
}  // namespace raygate
