// Compares direct light on surfaces with closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/light/bsdf.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using std::numbers::pi;
using enum IntegratorKind;

TEST(DirectLight, PointLightFallsOffWithTheSquare) {
  for (const glm::dvec3& at : {glm::dvec3(0, 2, 0), glm::dvec3(1, 2, -3), glm::dvec3(40, 9, 0)}) {
    Scene scene;
    scene.lights.push_back({glm::vec3(at), glm::vec3(5.0f)});
    const double squared = glm::dot(at, at), cosine = at.y / std::sqrt(squared);
    const double expected = 5.0 * cosine / squared / pi;
    EXPECT_NEAR(floor_radiance(scene, kWhitted, 1), expected, 1e-5 * expected);
    EXPECT_NEAR(floor_radiance(scene, kPath, 1), expected, 1e-5 * expected);
  }
}

TEST(DirectLight, ADirectionalLightFallsOffWithTheCosineAlone) {
  for (const glm::dvec3& way :
       {glm::dvec3(0, -1, 0), glm::dvec3(1, -0.3, 2), glm::dvec3(1, 1, 0)}) {
    Scene scene;
    scene.directional_lights.push_back({glm::normalize(way), glm::vec3(3.0f)});
    const double expected = 3.0 * std::max(0.0, -glm::normalize(way).y) / pi;
    EXPECT_NEAR(floor_radiance(scene, kWhitted, 1), expected, 1e-6);
    EXPECT_NEAR(floor_radiance(scene, kPath, 1), expected, 1e-6);
  }
}

// By KHR_lights_punctual, intensity falls with the square of a ramp of the cosine.
TEST(DirectLight, ASpotLightFadesBetweenItsAngles) {
  const auto seen = [](double degrees, IntegratorKind integrator) {
    const double angle = degrees * pi / 180.0;
    Scene scene;
    PointLight& light = scene.lights.emplace_back();
    light.position = {0, 2, 0};
    light.intensity = glm::dvec3(5.0);
    light.spot = {{std::sin(angle), -std::cos(angle), 0.0}, 20.0, 40.0};
    return floor_radiance(scene, integrator, 1);
  };
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const double full = 5.0 / 4.0 / pi;
    EXPECT_NEAR(seen(0.0, integrator), full, 1e-6);
    EXPECT_NEAR(seen(19.9, integrator), full, 1e-6);
    const double inner = std::cos(pi / 9), outer = std::cos(pi / 4.5);
    const double ramp = (std::cos(pi / 6) - outer) / (inner - outer);
    EXPECT_NEAR(seen(30.0, integrator), full * ramp * ramp, 1e-5);
    EXPECT_EQ(seen(40.1, integrator), 0.0f);
    EXPECT_EQ(seen(180.0, integrator), 0.0f);
  }
}

// The path tracer samples one of several kinds of lights at random; the mean is the sum of all.
TEST(DirectLight, LightsOfAllKindsAddUp) {
  Scene scene;
  scene.lights.push_back({{1, 2, 0}, glm::dvec3(5.0)});
  scene.lights.push_back({{0, 2, 1}, glm::dvec3(9.0), SpotCone{{0, -1, 0}, 10.0, 80.0}});
  scene.directional_lights.push_back({{0.6, -0.8, 0}, glm::vec3(2.0f)});
  add(scene, rectangle({-1, 1.5f, -1}, {0, 0, 1}, {0.5f, 0, 0}), emitter(glm::vec3(3.0f)));
  const double sum = floor_radiance(scene, kWhitted, 1024);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), sum, 0.005 * sum);
}

// The path tracer samples one of many near and far lights. The mean is the sum over all lights, as
// computed by Whitted. With gloss, scattered rays find lights just as often.
TEST(DirectLight, ManyLightsAddUp) {
  for (const float gloss : {0.0f, 0.6f}) {
    Scene scene;
    for (int i = 0; i < 60; ++i) {
      const float angle = 2.4f * float(i), far = 0.3f + 0.11f * float(i), size = 0.02f * float(i);
      const glm::vec3 at(far * std::cos(angle), 0.4f + 0.07f * float(i % 7), far * std::sin(angle));
      if (i % 5 == 0) {
        scene.lights.push_back({at, glm::dvec3(0.2)});
      } else {
        add(scene, rectangle(at, {size, 0.01f * float(i % 3), 0}, {0, 0.02f * float(i % 4), size}),
            emitter(glm::vec3(1.0f + float(i % 3))));
      }
    }
    Material floor = matte(glm::vec3(1.0f - gloss));
    floor.specular = glm::vec3(gloss);
    floor.shininess = 40.0f;
    floor.illumination_model = 2;
    add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), floor);
    const Camera camera = camera_at({0.2, 1e-3, 0}, {0.2, 0, 0}, 1e-3);
    const auto seen = [&](IntegratorKind integrator, int samples) {
      RenderSettings options = light(integrator, 1, 1, samples);
      options.max_depth = 0;
      options.ambient = 0.0;
      return double{film_of(scene, camera, options).color[0].r};
    };
    const double sum = seen(kWhitted, 4096);
    EXPECT_NEAR(seen(kPath, 1 << 15), sum, 0.005 * sum) << gloss;
  }
}

// The sky behind a light is darker, equal or brighter. Scattered rays find light and sky with the
// right weights, so the mean is right.
TEST(DirectLight, ALightBeforeASkyAddsUp) {
  for (const float radiance : {0.2f, 1.0f, 6.0f}) {
    Scene scene;
    add(scene, rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), emitter(glm::vec3(radiance)));
    add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
    scene.background = glm::vec3(1.0f);
    const Camera camera = camera_at({0, 1e-3, 0}, {0, 0, 0}, 1e-3);
    RenderSettings options = light(kPath, 1, 1, 1 << 14);
    options.max_depth = 0;
    // Form factor of a square of side 1 at distance 1, as four quarters.
    const double x = 0.5, r = std::sqrt(1 + x * x), form = 4 * x / r * std::atan(x / r) / pi;
    const double expected = radiance * form + (1.0 - form);
    EXPECT_NEAR(film_of(scene, camera, options).color[0].r, expected, 4e-3 * expected);
  }
}

// A corner of a parallel rectangle is straight above (Siegel and Howell's catalogue, B-4).
TEST(DirectLight, RectangularLightHasItsFormFactor) {
  const double a = 1.5, b = 0.8, height = 1.2;
  Scene scene;
  add(scene, rectangle({0, float(height), 0}, {float(a), 0, 0}, {0, 0, float(b)}),
      emitter(glm::vec3(3.0f)));
  const double x = a / height, y = b / height;
  const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double form = (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * pi);
  EXPECT_NEAR(floor_radiance(scene, kWhitted, 4096), 3.0 * form, 3e-4 * form);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), 3.0 * form, 3e-3 * form);
}

// A light with a half-black texture is as bright as its other half.
TEST(DirectLight, ATexturedLightShinesByTexel) {
  constexpr int kTexels = 256;
  std::vector<Texture::Texel> texels(kTexels, {0, 0, 0});
  std::fill_n(texels.begin(), kTexels / 2, Texture::Texel{255, 255, 255});
  Scene half, textured;
  add(half, rectangle({0, 1.2f, 0}, {1.5f, 0, 0}, {0, 0, 0.8f}), emitter(glm::vec3(3.0f)));
  textured.textures.emplace_back(kTexels, 1, texels);
  Material material = emitter(glm::vec3(3.0f));
  material.emission_map.texture = 0;
  material.emission_map.mapping.sampling = Wrap::kClamp;
  add(textured, rectangle({0, 1.2f, 0}, {3, 0, 0}, {0, 0, 0.8f}), material);
  textured.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  textured.triangles[0].texcoords = {0, 1, 2};
  textured.triangles[1].texcoords = {0, 2, 3};
  const float wanted = floor_radiance(half, kWhitted, 4096);
  EXPECT_NEAR(floor_radiance(textured, kWhitted, 4096), wanted, 1e-3f * wanted);
  EXPECT_NEAR(floor_radiance(textured, kPath, 4096), wanted, 1e-2f * wanted);
  // The camera sees the same; from below, +x is on the left.
  const Camera camera = camera_at({1.5, -3, 0.4}, {1.5, 1.2, 0.4}, 20.0);
  for (const IntegratorKind integrator : {kWhitted, kPath, IntegratorKind::kPrimary}) {
    const Film film = film_of(textured, camera, light(integrator, 8, 1, 1));
    for (std::size_t x = 0; x < 8; ++x) EXPECT_EQ(film.color[x].r, x < 4 ? 0.0f : 3.0f) << x;
  }
}

/// The expected radiance of the camera's middle pixel, which shows the origin: the BSDF times the
/// light of a lamp or of a point light of intensity 1.
class Expected {
 public:
  Expected(const Scene& scene, const Camera& camera) {
    const Bvh bvh(scene);
    const Ray ray = {camera.eye(), camera.direction(0.5, 0.5)};
    std::uint32_t floor = 0;
    while (!hits_triangle(ray, bvh.corners_of(floor))) ++floor;
    const Triangle& face = scene.triangles[bvh.triangle_of(floor)];
    bsdf_ = bsdf_at(scene, bvh, {&ray, floor, &face},
                    MaterialParameters(scene.materials[face.material]));
  }
  double of_point(const glm::dvec3& at) const {
    const Triple<float> way = triple(glm::normalize(at));
    return double(bsdf_.eval(way).x) * std::abs(way.y) / glm::dot(at, at);
  }
  double of_lamp(double height) const {
    constexpr int kSteps = 400;
    double integral = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const glm::dvec3 at(-1 + 2 * (i + 0.5) / kSteps, height, -2 + 1.5 * (k + 0.5) / kSteps);
        integral += of_point(at) * std::abs(height) / glm::length(at);
      }
    }
    return integral * 3.0 * 3.0 / kSteps / kSteps;
  }

 private:
  Bsdf<float> bsdf_;
};

std::vector<Corners> lamp(float height) {
  return rectangle({-1, height, -2}, {2, 0, 0}, {0, 0, 1.5f});
}
std::vector<Corners> wide_floor() { return rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}); }

// A rough floor with wide or narrow lobes, seen at an angle, has the radiance of the integral over
// its lamp. Both light samples and scattered rays find the lamp.
TEST(DirectLight, FacetsReflectALight) {
  for (const float roughness : {0.25f, 0.6f, 1.0f}) {
    Material material = facets(0.5f, roughness, 0.0f);
    material.diffuse = glm::vec3(0.8f);
    Scene scene;
    add(scene, lamp(2), emitter(glm::vec3(3.0f)));
    add(scene, wide_floor(), material);
    const Camera camera = camera_at({0, 1, 1.5}, {0, 0, 0}, 1e-3);
    const double integral = Expected(scene, camera).of_lamp(2);
    RenderSettings options = light(kPath, 1, 1, 4096);
    options.max_depth = 1;
    EXPECT_NEAR(film_of(scene, camera, options).color[0].r, integral, 0.01 * integral) << roughness;
    options.integrator = kWhitted;
    options.max_depth = 0;
    options.ambient = 0.0;
    EXPECT_NEAR(film_of(scene, camera, options).color[0].r, integral, 0.01 * integral) << roughness;
  }
}

// Through rough glass, a point light is visible, and an area light equals an integral.
TEST(DirectLight, RoughGlassShowsTheLightsBehindIt) {
  for (const float roughness : {0.3f, 0.7f, 1.0f}) {
    Scene scene;
    add(scene, wide_floor(), facets(0.0f, roughness, 1.0f));
    const Camera camera = camera_at({0, 1, 1.5}, {0, 0, 0}, 1e-3);
    RenderSettings options = light(kPath, 1, 1, 4096);
    options.max_depth = 1;
    options.ambient = 0.0;
    const Expected expected(scene, camera);
    for (const glm::dvec3& at : {glm::dvec3(0.2, -1, -1.0), {0.2, 1, -1.0}}) {
      Scene lit = scene;
      lit.lights.push_back({glm::vec3(at), glm::dvec3(2.0)});
      const double light = 2.0 * expected.of_point(at);
      EXPECT_GT(light, 1e-3);
      for (const IntegratorKind integrator : {kPath, kWhitted}) {
        options.integrator = integrator;
        EXPECT_NEAR(film_of(lit, camera, options).color[0].r, light, 1e-3 * light)
            << roughness << " " << at.y;
      }
    }
    add(scene, lamp(-2), emitter(glm::vec3(3.0f)));
    const double integral = expected.of_lamp(-2);
    // At depth 1, Whitted's rays find the lamp, too. The lamp must not count twice.
    for (const auto& [integrator, depth] : {std::pair(kPath, 1), {kWhitted, 0}, {kWhitted, 1}}) {
      options.integrator = integrator;
      options.max_depth = depth;
      EXPECT_NEAR(film_of(scene, camera, options).color[0].r, integral, 0.02 * integral)
          << roughness << " " << depth;
    }
  }
}

// The form factor of a parallel disc straight above is sin^2 of the angle from axis to rim.
TEST(DirectLight, DiscLightHasItsFormFactor) {
  std::vector<Corners> disc;
  constexpr int kParts = 512;
  const auto rim = [](int i) {
    const double angle = 2 * pi * i / kParts;
    return glm::vec3(0.7 * std::cos(angle), 1.1, 0.7 * std::sin(angle));
  };
  for (int i = 0; i < kParts; ++i) disc.push_back({glm::vec3(0, 1.1f, 0), rim(i), rim(i + 1)});
  Scene scene;
  add(scene, disc, emitter(glm::vec3(2.0f)));
  const double form = 0.49 / (0.49 + 1.21);
  EXPECT_NEAR(floor_radiance(scene, kWhitted, 4096), 2.0 * form, 1e-3 * form);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), 2.0 * form, 4e-3 * form);
}

// Below a square, a pixel of the floor is lit exactly if its line to the light misses the square.
TEST(DirectLight, ShadowOfASquareIsWhereItMustBe) {
  Scene scene;
  add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
  add(scene, rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), matte(glm::vec3(1.0f)));
  const glm::dvec3 light_at(0.7, 3, -0.2), way(-0.3, -1.0, 0.2);
  const Camera camera = camera_at({0, 0.9, 2.5}, {0.2, 0, 0}, 60.0);
  for (const auto& [integrator, is_far] :
       {std::pair(kWhitted, false), {kPath, false}, {kWhitted, true}, {kPath, true}}) {
    scene.lights.clear();
    scene.directional_lights.clear();
    if (is_far) {
      scene.directional_lights.push_back({glm::normalize(way), glm::vec3(1.0f)});
    } else {
      scene.lights.push_back({glm::vec3(light_at), glm::vec3(10.0f)});
    }
    RenderSettings options = light(integrator, 96, 96, 1);
    options.max_depth = 0;
    const Film film = film_of(scene, camera, options);
    int lit = 0, dark = 0;
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        const std::size_t pixel = std::size_t(y) * 96 + x;
        if (film.primitive[pixel] > 1) continue;  // the square itself, or nothing
        const glm::dvec3 view(camera.direction((x + 0.5) / 96, (y + 0.5) / 96));
        const glm::dvec3 eye(camera.eye()), point = eye - eye.y / view.y * view;
        const glm::dvec3 crossing =
            is_far ? point + way / way.y
                   : light_at + (light_at.y - 1.0) / (light_at.y - point.y) * (point - light_at);
        const double inside = std::max(std::abs(crossing.x), std::abs(crossing.z)) - 0.5;
        if (std::abs(inside) < 1e-6) continue;
        ASSERT_EQ(film.color[pixel].r == 0.0f, inside < 0.0) << x << ", " << y;
        ++(inside < 0.0 ? dark : lit);
      }
    }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(dark, 200);
  }
}

// Without light between scattering surfaces, both integrators give the same picture.
TEST(DirectLight, PathAndWhittedAgreeAboutDirectLight) {
  Scene scene = everything();
  scene.background = glm::vec3(0.0f);
  // The integrators treat shadows of glass differently, so make glass matte.
  scene.materials[4] = scene.materials[7] = matte(glm::vec3(0.5f));
  const Camera camera = camera_at({0.6, 0.2, 5}, {0, -0.3, 0}, 40.0);
  RenderSettings options = light(kWhitted, 24, 24, 256);
  options.max_depth = 0;
  options.ambient = 0.0;
  const glm::dvec3 whitted = mean_colour(film_of(scene, camera, options));
  options.integrator = kPath;
  const glm::dvec3 path = mean_colour(film_of(scene, camera, options));
  // The last rays of paths see lights in the mirror and through the window, where Whitted's rays
  // end. There are few such lights here.
  EXPECT_NEAR(path.r, whitted.r, 0.02 * whitted.r);
  EXPECT_NEAR(path.g, whitted.g, 0.02 * whitted.g);
}

}  // namespace
}  // namespace raygate
