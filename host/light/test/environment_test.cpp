// Compares an environment's pdf, samples and radiance with quadratures; tests pictures it lights.
#include "host/light/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using std::numbers::pi;

/// Returns a map of dim noise with a sun of one texel and a black part.
EnvironmentMap noisy(int width, int height) {
  std::mt19937 engine(5);
  EnvironmentMap map;
  map.width = width;
  map.height = height;
  map.strength = 2.0f;
  for (int i = 0; i < width * height; ++i) {
    const auto x = static_cast<float>(engine() % 1024) / 1024.0f;
    map.texels.emplace_back(x, 0.5f * x, i % width < width / 4 ? 0.0f : 1.0f);
  }
  for (int i = 0; i < width; ++i) map.texels[static_cast<std::size_t>(i)] = glm::vec3(0.0f);
  map.texels[static_cast<std::size_t>(width) * (static_cast<std::size_t>(height) / 3) + 2] =
      glm::vec3(300.0f);
  return map;
}

template <class F>
void for_all_directions(const F& f) {
  constexpr int kRows = 500, kColumns = 1000;
  for (int i = 0; i < kRows; ++i) {
    const double angle = pi * (i + 0.5) / kRows, sine = std::sin(angle);
    for (int k = 0; k < kColumns; ++k) {
      const double turn = 2 * pi * (k + 0.5) / kColumns;
      const glm::dvec3 way(sine * std::sin(turn), std::cos(angle), -sine * std::cos(turn));
      f(way, 2 * pi * pi * sine / (double(kRows) * kColumns));
    }
  }
}

TEST(Environment, ShowsItsTexelsWhereTheyAre) {
  const EnvironmentMap map = noisy(16, 8);
  const Environment environment(map);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double turn = 2 * pi * ((x + 0.5) / 16 - 0.5), angle = pi * (y + 0.5) / 8;
      const glm::dvec3 way(std::sin(angle) * std::sin(turn), std::cos(angle),
                           -std::sin(angle) * std::cos(turn));
      const Triple<float> seen = environment.radiance(triple(way));
      const glm::vec3 expected = 2.0f * map.texel(x, y);
      EXPECT_NEAR(seen.x, expected.x, 1e-4 * (expected.x + 10)) << x << " " << y;
      EXPECT_NEAR(seen.z, expected.z, 1e-4 * (expected.z + 10)) << x << " " << y;
    }
  }
}

TEST(Environment, DensityIsOneInAllAndNowhereFarFromTheBrightness) {
  for (const auto& [width, height] : {std::pair(16, 8), {7, 5}, {1, 1}, {2, 1}}) {
    EnvironmentMap map = noisy(16, 8);
    map.width = width;
    map.height = height;
    map.texels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    map.texels.back() = glm::vec3(3.0f);
    const Environment environment(map);
    double pdf = 0.0;
    glm::dvec3 radiance(0.0);
    for_all_directions([&](const glm::dvec3& way, double size) {
      const Triple<float> light = environment.radiance(triple(way));
      const float here = environment.pdf(triple(way));
      pdf += here * size;
      radiance += size * glm::dvec3(light.x, light.y, light.z);
      if (largest(light) > 0.0f) {
        ASSERT_GT(here, 0.0f);
      }
    });
    EXPECT_NEAR(pdf, 1.0, 2e-3) << width;
    const glm::dvec3 mean = environment.mean_radiance() * (4 * pi);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(radiance[k], mean[k], (width < 16 ? 0.05 : 0.02) * mean[k]) << width;
  }
}

TEST(Environment, SamplesHaveTheDensityThatIsClaimed) {
  EnvironmentMap map = noisy(16, 8);
  map.up = glm::normalize(glm::dvec3(1, 2, 0.5));
  map.ahead = glm::normalize(glm::cross(map.up, glm::dvec3(0, 1, -1)));
  const Environment environment(map);
  constexpr int kCount = 1 << 17;
  glm::dvec3 sampled(0.0), integral(0.0);
  double ideal = 0.0;
  const auto tested = [](const glm::dvec3& way) {
    return glm::dvec3(way.x * way.x, way.y + 1.0, way.z * way.x + 1.0);
  };
  for (int i = 0; i < kCount; ++i) {
    const Triple<float> way = environment.sample<float>(random_point<float>(i, 7u, 0));
    ASSERT_NEAR(dot(way, way), 1.0f, 1e-5f);
    sampled += tested({way.x, way.y, way.z}) / double(kCount);
    const Triple<float> light = environment.radiance(way);
    const double mean = (double{light.x} + light.y + light.z) / 3.0;
    const double share = mean / environment.pdf(way);
    ideal = std::max(ideal, share);
  }
  for_all_directions([&](const glm::dvec3& way, double size) {
    integral += tested(way) * (size * environment.pdf(triple(way)));
  });
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k], integral[k], 5e-3);
  const glm::dvec3 mean = environment.mean_radiance();
  EXPECT_LE(ideal, 4.01 * 4 * pi * (mean.x + mean.y + mean.z) / 3);
}

/// Returns a path-traced pixel of a floor with normal +y under an environment.
double floor_under(const EnvironmentMap& map, const Material& material, int samples) {
  Scene scene;
  add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), material);
  scene.environment = map;
  RenderSettings options = light(IntegratorKind::kPath, 1, 1, samples);
  options.max_depth = 1;
  return film_of(scene, camera_at({0, 1e-3, 0}, {0, 0, 0}, 1e-3), options).color[0].r;
}

TEST(Environment, LightsAFloorAsItsIntegralSays) {
  for (const bool has_sun : {true, false}) {
    EnvironmentMap map = noisy(16, 8);
    if (!has_sun) map.texels[16 * 2 + 2] = glm::vec3(0.0f);
    const Environment environment(map);
    double integral = 0.0;
    for_all_directions([&](const glm::dvec3& way, double size) {
      integral += environment.radiance(triple(way)).x * std::max(0.0, way.y) * size / pi;
    });
    EXPECT_NEAR(floor_under(map, matte(glm::vec3(1.0f)), 4096), integral, 0.01 * integral);
    Material rough = matte(glm::vec3(1.0f));
    rough.metallic_roughness = {0.0f, 1.0f, 0.0f};
    EXPECT_LT(floor_under(map, rough, 1024), 1.01 * integral);
    EXPECT_GT(floor_under(map, rough, 1024), 0.8 * integral);
  }
}

// An environment is seen through mirrors, on misses and as Whitted's ambient light.
TEST(Environment, IsSeenByAllThatSeesTheSky) {
  EnvironmentMap map;
  map.width = map.height = 1;
  map.texels = {{0.25f, 0.5f, 0.75f}};
  for (const IntegratorKind integrator : {IntegratorKind::kWhitted, IntegratorKind::kPath}) {
    for (const Material& material : {mirror(1.0f), matte(glm::vec3(1.0f)), glass(1.5f)}) {
      Scene scene;
      add(scene, sphere(2), material);
      scene.environment = map;
      const glm::dvec3 mean = mean_colour(
          film_of(scene, camera_at({0, 0, 4}, {0, 0, 0}, 45.0), light(integrator, 16, 16, 16)));
      // Some light is trapped in the glass.
      EXPECT_NEAR(mean.r, 0.25, 0.01);
      EXPECT_NEAR(mean.g, 0.5, 0.02);
    }
  }
}

}  // namespace
}  // namespace raygate
