// Tests that lights are chosen as often as their probabilities say, the outer sides of closed
// lights, and the default lights of scenes without lights.
#include "host/light/lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "host/base/test/using_vectors.h"
#include "host/light/environment.h"
#include "host/light/light_tree.h"
#include "host/light/test/light_scenes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::add, test::emitter, test::matte, test::rectangle;

constexpr std::uint32_t kSeed = 20;

/// Lights of all kinds at random places: points, spots, triangles, parallelograms, distant lights.
class ManyLights : public testing::TestWithParam<int> {
 protected:
  ManyLights() {
    for (int i = 0; i < GetParam(); ++i) {
      const glm::vec3 at = place();
      const float size = 0.01f + 0.2f * one();
      if (i % 4 == 0) {
        scene_.lights.push_back({at, glm::dvec3(0.01 + one())});
      } else if (i % 4 == 1) {
        const double inner = 40.0 * one();
        scene_.lights.push_back({at, glm::dvec3(one()),
                                 SpotCone{glm::dvec3(way()), inner, inner + 1.0 + 40.0 * one()}});
      } else {
        add(scene_,
            i % 4 == 2 ? rectangle(at, size * way(), size * way())
                       : std::vector<Corners>{{at, at + size * way(), at + size * way()}},
            emitter(glm::vec3(0.1f + 9.0f * one())));
      }
    }
    if (scene_.triangles.empty()) add(scene_, rectangle(way(), way(), way()), emitter({1, 1, 1}));
    scene_.directional_lights.push_back({glm::dvec3(way()), glm::vec3(0.1f)});
    scene_.directional_lights.push_back({glm::dvec3(way()), glm::vec3(0.5f)});
  }

  float one() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }
  glm::vec3 place() { return {8.0f * one() - 4.0f, 8.0f * one() - 4.0f, 8.0f * one() - 4.0f}; }
  glm::vec3 way() {
    for (;;) {
      const glm::vec3 v(2.0f * one() - 1.0f, 2.0f * one() - 1.0f, 2.0f * one() - 1.0f);
      if (glm::dot(v, v) < 1.0f && glm::dot(v, v) > 0.01f) return glm::normalize(v);
    }
  }

  /// Returns whether a source contributes at a surface point if nothing occludes it.
  bool brings(const Lights& lights, const Lights::Source& source, const glm::vec3& point,
              const glm::vec3& normal) {
    const Lights::Light& light = lights.light(source.light);
    if (light.kind == Lights::Kind::kDirection) return glm::dot(light.position, normal) > 0.0f;
    if (light.kind == Lights::Kind::kPoint) {
      const glm::vec3 to = light.position - point;
      const float cosine = -glm::dot(glm::normalize(to), light.spot_axis);
      return glm::dot(to, normal) > 0.0f &&
             (!light.is_spot || spot_falloff(cosine, light.spot_scale, light.spot_offset) > 0.0f);
    }
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t patches[] = {source.patch};
      const auto place = lights.sample_patches<float>(patches, {one(), one()}).position;
      if (glm::dot(glm::vec3(place.x, place.y, place.z) - point, normal) > 0.0f) return true;
    }
    return false;
  }

  std::mt19937 random_{kSeed};
  Scene scene_;
};

INSTANTIATE_TEST_SUITE_P(Numbers, ManyLights, testing::Values(0, 5, 40, 1000));

std::uint32_t count_of(const Lights& lights) { return lights.environment_source() + 1; }

// With Sampling::kAll there are the same lights, but no sources to choose from.
TEST_P(ManyLights, AreListedWithoutAChoice) {
  const Bvh bvh(scene_);
  const Lights chosen(scene_, bvh), all(scene_, bvh, Lights::Sampling::kAll);
  EXPECT_EQ(count_of(all), 0u);
  EXPECT_FALSE(all.any_power());
  ASSERT_EQ(all.count(), chosen.count());
  for (std::size_t i = 0; i < all.count(); ++i) {
    EXPECT_EQ(all.light(i).emission, chosen.light(i).emission);
    EXPECT_EQ(all.light(i).patches, chosen.light(i).patches);
  }
  EXPECT_EQ(all.ambient(), chosen.ambient());
}

// Surface points are everywhere, also among the lights.
TEST_P(ManyLights, ChancesAreOneInAllAndNoLightThatBringsLightHasNone) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  int bringing = 0;
  double all = 0.0;
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 point = place(), normal = way();
    double sum = 0.0;
    for (std::uint32_t source = 0; source < count_of(lights); ++source) {
      const float pmf = lights.pmf<float>(source, point, normal);
      sum += double{pmf};
      if (brings(lights, lights.source(source), point, normal)) {
        ++bringing;
        EXPECT_GT(pmf, 0.0f) << "seed " << kSeed << ", source " << source;
      }
    }
    EXPECT_LT(sum, 1.0 + 1e-5);
    all += sum;
  }
  EXPECT_GT(bringing, 50);
  // Below 1 where a cluster (mostly of spots) seems to contribute but none of its sources does.
  EXPECT_GT(all / 100, 0.7);
}

// For evenly spaced u, the counts of sample_source() match pmf() within the spacing.
TEST_P(ManyLights, ArePickedAsOftenAsTheirChance) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  constexpr int kPicks = 40000;
  for (int i = 0; i < 4; ++i) {
    const glm::vec3 point = place(), normal = way();
    std::vector<int> picked(count_of(lights));
    int none = 0;
    for (int k = 0; k < kPicks; ++k) {
      const auto choice = lights.sample_source<float>(point, normal, (k + 0.5) / kPicks);
      if (choice.source == kNoIndex) {
        ++none;
        continue;
      }
      ++picked[choice.source];
      ASSERT_NEAR(choice.pmf, lights.pmf<float>(choice.source, point, normal), 1e-5f * choice.pmf);
    }
    EXPECT_LT(none, kPicks);
    for (std::uint32_t source = 0; source < count_of(lights); ++source) {
      ASSERT_NEAR(picked[source], kPicks * lights.pmf<float>(source, point, normal), 1.01);
    }
  }
}

// Weighting one child at a time or eight at once gives the same bits.
TEST_P(ManyLights, LanesChangeNoBit) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  int cases = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 point = place(), normal = way();
    const double u = double{one()} * 0.999;
    const auto one_by_one = lights.sample_source<float>(point, normal, u);
    for (const Vectors vectors : machine_vectors()) {
      const UsingVectors in_use(vectors);
      in_vectors([&](auto code) RAYGATE_BODY {
        using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
        const auto choice = lights.sample_source<T>(point, normal, u);
        EXPECT_EQ(choice.source, one_by_one.source);
        EXPECT_EQ(choice.pmf, one_by_one.pmf);
        ++cases;
        return 0;
      });
    }
  }
  EXPECT_GE(cases, 2000);
}

TEST(LightTree, PrefersWhatIsNearAndFacesTheSurface) {
  std::vector<LightBounds> sources(64);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    sources[i].middle = glm::dvec3(static_cast<double>(i), 1.0, 0.0);
    sources[i].power = 1.0;
  }
  const LightTree tree(sources);
  const glm::vec3 up(0, 1, 0);
  for (const float x : {3.0f, 20.0f, 50.0f}) {
    const auto here = static_cast<std::uint32_t>(x);
    EXPECT_GT(tree.pmf<float>(here, {x, 0, 0}, up), 0.25f) << "of 64";
    EXPECT_LT(tree.pmf<float>(here > 32 ? 0 : 63, {x, 0, 0}, up), 0.003f);
    EXPECT_EQ(tree.sample<float>({x, 0, 0}, -up, 0.5).source, kNoIndex) << "all are behind";
  }
}

/// Returns the outer sides of all triangles, in their order.
std::vector<OuterSide> sides_of(const std::vector<Corners>& triangles) {
  const Scene scene = test::scene_of(triangles);
  const Bvh bvh(scene);
  std::vector<std::uint32_t> primitives(triangles.size());
  for (std::uint32_t primitive = 0; primitive < primitives.size(); ++primitive)
    primitives[bvh.triangle_of(primitive)] = primitive;
  return outer_sides(bvh, primitives);
}

TEST(OuterSides, OfEachSphereAreOutside) {
  std::vector<Corners> all = test::sphere(1, 1.0f, {0, 0, 0});
  const std::size_t count = all.size();
  for (Corners triangle : test::sphere(1, 1.0f, {5, 0, 0})) {
    std::swap(triangle[0], triangle[1]);
    all.push_back(triangle);
  }
  const auto sides = sides_of(all);
  ASSERT_EQ(sides.size(), 2 * count);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    ASSERT_EQ(sides[i], i < count ? OuterSide::kAlongNormal : OuterSide::kAgainstNormal);
  }
}

TEST(OuterSides, AreBothOfWhatIsOpen) {
  std::vector<Corners> hole = test::sphere(1, 1.0f, {0, 0, 0}), torn = hole;
  hole.pop_back();
  std::swap(torn[3][0], torn[3][1]);  // reverses one triangle
  for (const auto& sides :
       {sides_of(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), sides_of(hole), sides_of(torn)}) {
    for (const OuterSide side : sides) ASSERT_EQ(side, OuterSide::kBoth);
  }
}

constexpr glm::vec3 kBlue(0.1f, 0.2f, 0.4f);

Scene square(const Material& material) {
  Scene scene;
  add(scene, rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
  return scene;
}

Camera camera_from(const glm::dvec3& eye) { return Camera::look_at({.eye = eye}, 1.0); }

TEST(DefaultLights, AreOneLightAboveTheCamera) {
  const auto lights = default_lights(square(matte(glm::vec3(0.5f))), camera_from({0, 0, 5}));
  ASSERT_TRUE(lights && lights->points.size() == 1);
  EXPECT_LT(lights->points[0].position.x, 0.0f);
  EXPECT_GT(lights->points[0].position.y, 0.0f);
  EXPECT_GT(lights->points[0].position.z, 0.0f);
  EXPECT_NE(lights->background, glm::vec3(0.0f));
}

// Sixteen times the size of this scene is beyond the range of float.
TEST(DefaultLights, StayInTheRangeOfTreesAndPredicates) {
  Scene scene;
  add(scene, rectangle({-8e37f, -8e37f, 0}, {1.6e38f, 0, 0}, {0, 1.6e38f, 0}),
      matte(glm::vec3(0.5f)));
  const auto lights = default_lights(scene, camera_from({0, 0, 3e38}), true);
  ASSERT_FALSE(lights->points.empty());
  for (const PointLight& light : lights->points) {
    EXPECT_LE(largest(light.position), kMostCoordinate);
  }
}

// White surfaces that face the camera are not clipped by Whitted, and hardly by paths.
TEST(DefaultLights, LeaveWhiteBelowOne) {
  Scene scene;
  add(scene, test::sphere(4), matte(glm::vec3(1.0f)));
  for (const double side : {-3.0, 0.0, 3.0}) {
    const Camera camera = camera_from({side, 1.5, 4});
    for (const bool is_first_look : {false, true}) {
      RenderSettings options = test::light(IntegratorKind::kWhitted, 32, 32, 1);
      const auto lights = default_lights(scene, camera, is_first_look);
      float most = 0.0f;
      for (const glm::vec4& color : test::film_of(scene, camera, options, lights).color) {
        most = std::max({most, color.r, color.g, color.b});
      }
      EXPECT_LE(most, 1.0f);
      EXPECT_GT(most, 0.7f);
      if (!is_first_look) continue;
      options.integrator = IntegratorKind::kPath;
      options.samples = 512;  // many samples, so that noise does not matter
      const Film film = test::film_of(scene, camera, options, lights);
      EXPECT_LT(std::ranges::count_if(film.color, [](const auto& color) { return color.b > 1.0f; }),
                10);
    }
  }
}

TEST(PreviewLights, AreTwoLightsAndTheBackground) {
  Scene scene = square(matte(glm::vec3(0.5f)));
  scene.background = kBlue;
  const auto lights = default_lights(scene, camera_from({0, 0, -5}), true);
  ASSERT_TRUE(lights && lights->points.size() == 2);
  EXPECT_EQ(lights->background, kBlue);
  // From behind, the camera's left is +x; the lights are on the camera's side.
  EXPECT_GT(lights->points[0].position.x, 0.0f);
  EXPECT_LT(lights->points[1].position.x, 0.0f);
  for (const PointLight& light : lights->points) EXPECT_LT(light.position.z, 0.0f);
  EXPECT_GT(lights->points[0].intensity.x, lights->points[1].intensity.x);
}

// A roof hides a part of a spherical light's disc. A circular segment of the disc stays visible.
TEST(DefaultLights, CastSoftShadows) {
  const Scene wall = square(matte(glm::vec3(0.5f)));
  EXPECT_GT(default_lights(wall, camera_from({0, 0, 5}))->radius, 0.0);
  EXPECT_GT(default_lights(wall, camera_from({0, 0, 5}), true)->radius, 0.0);
  const auto floor_at = [](double x, IntegratorKind integrator, bool has_roof) {
    Scene scene;
    add(scene, rectangle({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}), matte(glm::vec3(0.5f)));
    if (has_roof) add(scene, rectangle({0, 1, -9}, {0, 0, 18}, {9, 0, 0}), matte(glm::vec3(0.0f)));
    const Camera camera =
        Camera::look_at({.eye = {x - 1, 0.5, 0.1}, .target = {x, 0, 0}, .fov = 1e-3}, 1.0);
    RenderSettings options = test::light(integrator, 1, 1, 4096);
    options.ambient = 0.0;
    options.max_depth = 1;
    const CameraLights lights{{{{0, 101, 0}, glm::dvec3(1e4)}}, glm::vec3(0.0f), 10.0};
    return double(test::film_of(scene, camera, options, lights).color[0].r);
  };
  for (const IntegratorKind integrator : {IntegratorKind::kWhitted, IntegratorKind::kPath}) {
    for (const double part : {-0.8, -0.5, 0.0, 0.5}) {
      // The line from x past the edge, at (0, 1), meets the disc at `part` radii from its centre.
      const double x = -part * 10.0 / 100.0;
      const double seen =
          1.0 - (std::acos(part) - part * std::sqrt(1.0 - part * part)) / std::numbers::pi;
      EXPECT_NEAR(floor_at(x, integrator, true) / floor_at(x, integrator, false), seen, 0.01)
          << part;
    }
  }
}

// Default lights replace small emitters in previews only, and faint emissive pictures always.
TEST(DefaultLights, AreThoseOfScenesThatNothingLights) {
  const auto expect = [](const Scene& scene, bool by_default, bool in_preview, const char* what) {
    EXPECT_EQ(default_lights(scene, camera_from({0, 0, 5})).has_value(), by_default) << what;
    const auto lights = default_lights(scene, camera_from({0, 0, 5}), true);
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
  const auto lights = default_lights(scene, camera_from({0, 0, 2}), true);
  ASSERT_TRUE(lights && lights->points.size() == 1);
  EXPECT_EQ(lights->points[0].position, glm::vec3(0, 0, 2));
}

}  // namespace
}  // namespace raygate
