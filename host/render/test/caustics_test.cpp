// Compares caustics by light paths with closed forms and with long runs without light paths.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/base/test/using_vectors.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using std::numbers::pi;

Film caustics_of(const Scene& scene, const Camera& camera, RenderSettings options) {
  RenderStats stats;
  const Bvh bvh(scene);
  return test::render(scene, bvh, camera, options, cpu(bvh), stats);
}

RenderSettings options_of(int size, int samples, bool caustics = true) {
  RenderSettings options = light(IntegratorKind::kPath, size, size, samples);
  options.caustics = caustics;
  return options;
}

constexpr float kHigh = 5.0f, kThick = 1.0f;  // height of the slab's top; its thickness

/// Returns a dark floor below a slab of glass. above_floor() sees the central square of side 1.
Scene slab() {
  Scene scene;
  add(scene, rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), matte(glm::vec3(0.1f)));
  add(scene, box({-1.5f, kHigh - kThick, -1.5f}, {1.5f, kHigh, 1.5f}), glass(1.5f));
  return scene;
}
Camera above_floor() { return camera_at({0, 2, 0}, {0, 0, 0}, 2.0 * 180.0 / pi * std::atan(0.25)); }

// Every reflection inside the slab transmits a little more light, by Fresnel's formulas.
TEST(Caustics, ASlabLetsTheSunThroughAsFresnelSays) {
  for (const double degrees : {0.0, 5.0}) {
    const double angle = degrees * pi / 180.0;
    Scene scene = slab();
    scene.directional_lights.push_back({{std::sin(angle), -std::cos(angle), 0.0}, glm::vec3(3.0f)});
    const double r = reflectance(angle);
    const double expected = 3.0 * std::cos(angle) * (1.0 - r) / (1.0 + r) * 0.1 / pi;
    const double found = mean_colour(caustics_of(scene, above_floor(), options_of(16, 1024))).x;
    EXPECT_NEAR(found, expected, 0.01 * expected) << degrees;
    EXPECT_EQ(mean_colour(caustics_of(scene, above_floor(), options_of(16, 4, false))).x, 0.0);
  }
}

// Above the slab is a point light. Each number of reflections inside gives a ring, by Snell's law.
TEST(Caustics, ASlabBendsALampsLightAsSnellSays) {
  constexpr double kLamp = 7.0, kIndex = 1.5;
  Scene scene = slab();
  scene.lights.push_back({{0, float(kLamp), 0}, glm::dvec3(500.0)});
  const auto irradiance = [&](double radius) {
    double sum = 0.0;
    for (int order = 0; order < 4; ++order) {
      const auto arrives = [&](double angle) {
        const double bent = std::asin(std::sin(angle) / kIndex);
        return (kLamp - kThick) * std::tan(angle) + (2 * order + 1) * kThick * std::tan(bent);
      };
      double low = 0.0, high = 0.3;
      for (int i = 0; i < 60; ++i) {
        (arrives(0.5 * (low + high)) < radius ? low : high) = 0.5 * (low + high);
      }
      const double step = 1e-6, slope = (arrives(low + step) - arrives(low)) / step;
      const double r = reflectance(low);
      sum += 500.0 * std::sin(low) / (radius * slope) * (1 - r) * (1 - r) * std::pow(r, 2 * order);
    }
    return sum;
  };
  double expected = 0.0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) {
      expected +=
          irradiance(std::hypot((x + 0.5) / 32 - 0.5, (y + 0.5) / 32 - 0.5)) / 1024 * 0.1 / pi;
    }
  }
  RenderSettings options = options_of(16, 8192);
  options.filter = ReconstructionFilter::kBox;
  EXPECT_NEAR(mean_colour(caustics_of(scene, above_floor(), options)).x, expected, 0.01 * expected);
}

// Light that a flat mirror reflects to a floor seems to come from the lamp's mirror image.
TEST(Caustics, AMirrorIsAnotherLamp) {
  Scene floor;
  add(floor, rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), matte(glm::vec3(0.5f)));
  add(floor, rectangle({1, 3, -0.5f}, {0, 1, 0.3f}, {0, 0, 1}), emitter({4, 3, 2}));
  Scene with_mirror = floor, with_lamp = floor;
  add(with_mirror, rectangle({3, 0.1f, -1.5f}, {0, 0, 3}, {0, 4, 0}), mirror(0.8f));
  add(with_lamp, rectangle({5, 3, -0.5f}, {0, 1, 0.3f}, {0, 0, 1}), emitter({3.2f, 2.4f, 1.6f}));
  const glm::dvec3 expected =
      mean_colour(caustics_of(with_lamp, above_floor(), options_of(16, 1024)));
  for (const bool caustics : {false, true}) {
    const glm::dvec3 found =
        mean_colour(caustics_of(with_mirror, above_floor(), options_of(16, 1024, caustics)));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 0.01 * expected[k]);
  }
}

/// Compares means over quarters of pictures with and without light paths, for several seeds. The
/// largest difference must be within 4.5 standard errors: chance exceeds this in 1 of 10^4 scenes.
void expect_same_means(const Scene& scene, const Camera& camera, int samples) {
  constexpr int kSize = 24, kSeeds = 12;
  struct Sums {
    double sum[12] = {}, squares[12] = {};
  };
  const auto sums_of = [&](bool caustics, int spp) {
    Sums sums;
    for (int seed = 0; seed < kSeeds; ++seed) {
      RenderSettings options = options_of(kSize, spp, caustics);
      options.seed = std::uint64_t(1000 * int(caustics) + seed);
      const Film film = caustics_of(scene, camera, options);
      double means[12] = {};
      for (int i = 0; i < kSize * kSize; ++i) {
        const int quarter = i / (kSize * kSize / 2) * 2 + i % kSize / (kSize / 2);
        for (int k = 0; k < 3; ++k) means[3 * quarter + k] += double{film.color[std::size_t(i)][k]};
      }
      for (int k = 0; k < 12; ++k) {
        sums.sum[k] += means[k] / kSeeds;
        sums.squares[k] += means[k] * means[k] / kSeeds;
      }
    }
    return sums;
  };
  const Sums by_chance = sums_of(false, samples), on = sums_of(true, samples / 4);
  for (int k = 0; k < 12; ++k) {
    const double variance = by_chance.squares[k] - by_chance.sum[k] * by_chance.sum[k] +
                            on.squares[k] - on.sum[k] * on.sum[k];
    EXPECT_NEAR(on.sum[k], by_chance.sum[k], 4.5 * std::sqrt(variance / (kSeeds - 1))) << k;
  }
}

/// Returns everything() with a larger lamp, which camera paths also find, and no point light.
Scene room() {
  Scene scene = everything();
  scene.lights.clear();
  return scene;
}
Camera into_room() { return camera_at({0.3, 0.2, 5.5}, {0, -0.6, 0}, 32.0); }

TEST(Caustics, HaveTheMeansOfChance) { expect_same_means(room(), into_room(), 256); }

TEST(Caustics, AreSeenByALens) {
  CameraSetting setting{{0.3, 0.2, 5.5}, {0, -0.6, 0}, {}, 32.0};
  setting.lens.aperture = 0.2;
  expect_same_means(room(), Camera::look_at(setting, 1.0), 256);
}

/// Adds a ball of triangles with the vertex normals of a sphere.
void add_smooth(Scene& scene, const glm::vec3& middle, float radius, const Material& material) {
  const std::size_t first = scene.triangles.size();
  add(scene, sphere(2, radius, middle), material);
  for (std::size_t i = first; i < scene.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      scene.triangles[i].normals[k] = static_cast<std::uint32_t>(scene.normals.size());
      scene.normals.push_back(
          glm::normalize(scene.positions[scene.triangles[i].vertices[k]] - middle));
    }
  }
}

/// Returns a dim sky with a bright part, which camera paths find, too.
EnvironmentMap sky() {
  EnvironmentMap map;
  map.width = 8;
  map.height = 4;
  map.texels.assign(32, glm::vec3(0.3f, 0.4f, 0.5f));
  map.texels[3] = map.texels[10] = glm::vec3(6, 5, 4);
  return map;
}

// Surfaces of all kinds are seen in a mirror, under a lamp and a sky with a bright part.
TEST(Caustics, InAMirrorHaveTheMeansOfChance) {
  Scene scene;
  add(scene, rectangle({-3, -1, -3}, {0, 0, 6}, {6, 0, 0}), matte({0.7f, 0.6f, 0.5f}));
  add(scene, rectangle({-3, -1, -3}, {6, 0, 0}, {0, 4, 0}), mirror(0.9f));
  add(scene, rectangle({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), emitter({4, 3, 2}));
  add_smooth(scene, {-1, -0.2f, -1}, 0.7f, glass(1.5f));
  add_smooth(scene, {0.5f, -0.5f, -1}, 0.5f, facets(0.0f, 0.3f, 1.0f));
  add_smooth(scene, {0.2f, -0.5f, -2.2f}, 0.4f, facets(1.0f, 0.0f, 0.0f));
  Material half = matte(glm::vec3(0.4f));
  half.specular = glm::vec3(0.4f);
  half.illumination_model = 3;
  add_smooth(scene, {-1.9f, -0.6f, -2}, 0.4f, half);
  add_smooth(scene, {-0.6f, -0.6f, -2.4f}, 0.4f, facets(1.0f, 0.4f, 0.0f));
  scene.environment = sky();
  expect_same_means(scene, camera_at({0, 0.6, 2}, {0, -0.3, -3}, 60.0), 256);
}

TEST(Caustics, AreTheSameBytesWhoeverTraces) {
  Scene scene = everything();
  const Bvh bvh(scene);
  const PreparedScene prepared(scene, bvh);
  const Camera camera = into_room();
  const auto picture = [&](const RenderSettings& options, const IntersectorFactory& engine,
                           const Film* unfinished = nullptr) {
    RenderStats stats;
    return raygate::render({prepared, camera, options, {}, unfinished}, engine, stats);
  };
  RenderSettings options = options_of(72, 8);
  const Film whole = picture(options, cpu(bvh));
  options.caustics = false;
  EXPECT_FALSE(same(picture(options, cpu(bvh)), whole));
  options.caustics = true;
  EXPECT_TRUE(same(picture(options, pipeline_model(bvh)), whole));
  options.threads = 4;
  EXPECT_TRUE(same(picture(options, cpu(bvh)), whole));
  {
    const UsingVectors using_vectors(Vectors::kBaseline);
    EXPECT_TRUE(same(picture(options, cpu(bvh)), whole));
  }

  options.window = {9, 30, 50, 61};
  const Film crop = picture(options, cpu(bvh));
  for (int y = 30; y < 61; ++y) {
    for (int x = 9; x < 50; ++x) {
      ASSERT_EQ(crop.color[crop.index_of(x, y)], whole.color[whole.index_of(x, y)])
          << x << " " << y;
    }
  }
  options.window = {};

  // The render stops after some samples and resumes.
  options.channels.sums = true;
  options.end_sample = 3;
  const Film first = picture(options, cpu(bvh));
  options.end_sample = 0;
  options.threads = 1;
  EXPECT_TRUE(same(picture(options, cpu(bvh), &first), whole));
  // Resumes a cancelled render, whose tiles have different numbers of samples.
  RenderStats stats;
  int asked = 0;
  const Film part = test::render(scene, bvh, into_room(), options, cpu(bvh), stats,
                                 {.progress = [&](double) { return ++asked < 2; }});
  ASSERT_TRUE(stats.cancelled);
  EXPECT_TRUE(same(picture(options, cpu(bvh), &part), whole));
}

}  // namespace
}  // namespace raygate
