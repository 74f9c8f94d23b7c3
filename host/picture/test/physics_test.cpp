// Pictures whose light is known: by a closed form, by symmetry, or because it must balance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/light/bsdf.h"
#include "host/light/lights.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr double kPi = std::numbers::pi;
constexpr auto kWhitted = IntegratorKind::kWhitted, kPath = IntegratorKind::kPath;

glm::dvec3 mean_colour(const Film& film) {
  glm::dvec3 sum(0.0);
  for (const glm::vec4& colour : film.color) sum += glm::dvec3(colour);
  return sum / static_cast<double>(film.color.size());
}

// White things in a white world cannot be seen: what absorbs nothing sends on all that arrives.
TEST(Physics, WhiteFurnace) {
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
    // Total reflection between the flat faces of the glass keeps a few rays in it for ever.
    EXPECT_LE(dark, material.illumination_model == 7 ? covered / 20 : 0)
        << "illum " << material.illumination_model;
  }
}

// What catches shadows looks like the background, and is darker where something keeps light away.
TEST(Physics, AShadowCatcherIsSeenWhereItsShadowsAre) {
  Material catcher = matte(glm::vec3(0.0f));
  catcher.illumination_model = 10;
  Scene scene;
  add(scene, rectangle({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), catcher);
  scene.background = {0.2f, 0.3f, 0.4f};
  scene.lights.push_back({{3, 8, 2}, glm::dvec3(40.0)});
  const Camera camera = camera_at({0, 5, 9}, {0, 0, 0}, 40.0);
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const glm::dvec3 mean = mean_colour(film_of(scene, camera, light(integrator, 24, 24, 64)));
    const double tolerance = integrator == kWhitted ? 1e-6 : 0.01;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], scene.background[k], tolerance) << k;
  }
  Scene shaded = scene;
  add(shaded, rectangle({-1, 4, 1}, {2, 0, 0}, {0, 0, -2}), matte(glm::vec3(0.5f)));
  const Film film = film_of(shaded, camera, light(kWhitted, 24, 24, 1));
  int dark = 0;
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    if (film.primitive[i] > 1) continue;
    const bool is_dark = film.color[i].g < 0.29f;
    EXPECT_TRUE(is_dark || std::abs(film.color[i].g - 0.3f) < 1e-6f);
    dark += is_dark;
  }
  EXPECT_GT(dark, 10);
}

Material facets(float metallic, float roughness, float transmission) {
  Material material = matte(glm::vec3(1.0f));
  material.metallic_roughness = {metallic, roughness, transmission, {}, {}};
  return material;
}

// Facets hide light from each other, which is lost; nothing is made.
TEST(Physics, WhiteFurnaceOfFacets) {
  struct Case {
    float metallic, roughness, transmission, least;
  };
  for (const Case& c : {Case{1, 0, 0, 0.999f},
                        {1, 0.3f, 0, 0.95f},
                        {1, 1, 0, 0.5f},
                        {0, 0, 0, 0.999f},
                        {0, 0.5f, 0, 0.9f},
                        {0.5f, 0.5f, 0, 0.8f},
                        {0, 0.2f, 1, 0.93f},
                        {0, 0.5f, 0.5f, 0.85f}}) {
    Scene scene;
    add(scene, sphere(2), facets(c.metallic, c.roughness, c.transmission));
    scene.background = glm::vec3(1.0f);
    const Camera camera = camera_at({0, 0, 4}, {0, 0, 0}, 30.0);
    for (const IntegratorKind integrator : {kPath, kWhitted}) {
      const Film film = film_of(scene, camera, light(integrator, 24, 24, 16));
      const glm::dvec3 mean = mean_colour(film);
      EXPECT_LE(mean.g, 1.002) << c.metallic << " " << c.roughness << " " << c.transmission;
      EXPECT_GE(mean.g, c.least) << c.metallic << " " << c.roughness << " " << c.transmission;
    }
  }
}

/// A square at z = 0 from -1 to 1, with texture coordinates from 0 to 1.
void add_picture(Scene& scene, const Material& material) {
  add(scene, rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
  const auto first = static_cast<std::uint32_t>(scene.texcoords.size());
  for (const glm::vec2 corner : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
    scene.texcoords.push_back(corner);
  }
  const std::size_t count = scene.triangles.size();
  scene.triangles[count - 2].texcoords = {first, first + 1, first + 2};
  scene.triangles[count - 1].texcoords = {first, first + 2, first + 3};
}

// What a mask hides is not there, for camera rays and for shadows; its triangle is hit all the
// same.
TEST(Physics, AMaskHidesHalfOfASquare) {
  Material masked = matte(glm::vec3(0.5f));
  masked.opacity_map.texture = 0;
  masked.opacity_map.mapping.clamp = true;
  const auto scene_with = [&](bool has_square) {
    Scene scene;
    scene.textures.emplace_back(8, 1,
                                std::vector<Texture::Texel>{{0, 0, 0},
                                                            {0, 0, 0},
                                                            {0, 0, 0},
                                                            {0, 0, 0},
                                                            {255, 255, 255},
                                                            {255, 255, 255},
                                                            {255, 255, 255},
                                                            {255, 255, 255}});
    add(scene, rectangle({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), matte(glm::vec3(0.8f)));
    if (has_square) add_picture(scene, masked);
    scene.lights.push_back({{0, 0, 9}, glm::dvec3(80.0)});
    scene.background = glm::vec3(0.1f);
    return scene;
  };
  const Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 25.0);
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const RenderOptions options = light(integrator, 40, 40, integrator == kPath ? 64 : 1);
    const Film with = film_of(scene_with(true), camera, options);
    const Film without = film_of(scene_with(false), camera, options);
    int hidden = 0, seen = 0;
    for (int y = 8; y < 32; ++y) {
      for (int x = 9; x < 31; ++x) {
        const auto i = static_cast<std::size_t>(40 * y + x);
        ASSERT_GE(with.primitive[i], 2u) << "the square is hit";
        const float difference = std::abs(with.color[i].g - without.color[i].g);
        if (x < 19 && integrator == kWhitted) {
          ASSERT_LT(difference, 1e-5f) << x << " " << y;
          ++hidden;
        } else if (x > 20) {
          ASSERT_GT(difference, 0.01f) << x << " " << y;
          ++seen;
        }
      }
    }
    EXPECT_TRUE(integrator == kPath || hidden > 200);
    EXPECT_GT(seen, 200);
  }
}

// A map that leans along u turns the normal to where u grows.
TEST(Physics, ANormalMapTurnsTheNormal) {
  for (const bool is_mirrored : {false, true}) {
    Material bumpy = matte(glm::vec3(0.5f));
    bumpy.normal_map.texture = 0;
    bumpy.normal_map.mapping.scale.x = is_mirrored ? -1.0f : 1.0f;
    Scene scene;
    scene.textures.emplace_back(1, 1, std::vector<Texture::Texel>{{204, 140, 204}});
    add_picture(scene, bumpy);
    scene.background = glm::vec3(1.0f);
    const Film film =
        film_of(scene, camera_at({0, 0, 6}, {0, 0, 0}, 15.0), light(kWhitted, 5, 5, 1));
    const glm::vec3 wanted =
        glm::normalize(glm::vec3(is_mirrored ? -0.6f : 0.6f, 2 * 140 / 255.0f - 1, 0.6f));
    for (const glm::vec3& normal : film.normal) {
      EXPECT_LT(glm::length(normal - wanted), 1e-6f) << normal.x << " " << normal.y;
    }
  }
}

// In a closed room whose walls all glow and reflect the share r, light adds up to 1 / (1 - r).
TEST(Physics, ClosedFurnaceAddsUpTheGeometricSeries) {
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

// No mix of materials in a white world is brighter than the world.
TEST(Physics, EnergyIsNeverMade) {
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

/// One pixel that looks straight down at the origin of a white floor.
float floor_radiance(Scene scene, IntegratorKind integrator, int samples) {
  add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
  const Camera camera = camera_at({0, 1e-3, 0}, {0, 0, 0}, 1e-3);
  RenderOptions options = light(integrator, 1, 1, samples);
  options.max_depth = 0;
  options.ambient = 0.0;
  return film_of(scene, camera, options).color[0].r;
}

TEST(Physics, PointLightFallsOffWithTheSquare) {
  for (const glm::dvec3& at : {glm::dvec3(0, 2, 0), glm::dvec3(1, 2, -3), glm::dvec3(40, 9, 0)}) {
    Scene scene;
    scene.lights.push_back({glm::vec3(at), glm::vec3(5.0f)});
    const double squared = glm::dot(at, at), cosine = at.y / std::sqrt(squared);
    const double expected = 5.0 * cosine / squared / kPi;
    EXPECT_NEAR(floor_radiance(scene, kWhitted, 1), expected, 1e-5 * expected);
    EXPECT_NEAR(floor_radiance(scene, kPath, 1), expected, 1e-5 * expected);
  }
}

TEST(Physics, ADirectionalLightFallsOffWithTheCosineAlone) {
  for (const glm::dvec3& way :
       {glm::dvec3(0, -1, 0), glm::dvec3(1, -0.3, 2), glm::dvec3(1, 1, 0)}) {
    Scene scene;
    scene.directional_lights.push_back({glm::normalize(way), glm::vec3(3.0f)});
    const double expected = 3.0 * std::max(0.0, -glm::normalize(way).y) / kPi;
    EXPECT_NEAR(floor_radiance(scene, kWhitted, 1), expected, 1e-6);
    EXPECT_NEAR(floor_radiance(scene, kPath, 1), expected, 1e-6);
  }
}

// KHR_lights_punctual: the square of a ramp of the cosine.
TEST(Physics, ASpotLightFadesBetweenItsAngles) {
  const auto seen = [](double degrees, IntegratorKind integrator) {
    const double angle = degrees * kPi / 180.0;
    Scene scene;
    PointLight& light = scene.lights.emplace_back();
    light.position = {0, 2, 0};
    light.intensity = glm::dvec3(5.0);
    light.spot = {{std::sin(angle), -std::cos(angle), 0.0}, 20.0, 40.0};
    return floor_radiance(scene, integrator, 1);
  };
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const double full = 5.0 / 4.0 / kPi;
    EXPECT_NEAR(seen(0.0, integrator), full, 1e-6);
    EXPECT_NEAR(seen(19.9, integrator), full, 1e-6);
    const double inner = std::cos(kPi / 9), outer = std::cos(kPi / 4.5);
    const double ramp = (std::cos(kPi / 6) - outer) / (inner - outer);
    EXPECT_NEAR(seen(30.0, integrator), full * ramp * ramp, 1e-5);
    EXPECT_EQ(seen(40.1, integrator), 0.0f);
    EXPECT_EQ(seen(180.0, integrator), 0.0f);
  }
}

// Which of several kinds of lights is asked, chance says; the mean is the sum of all.
TEST(Physics, LightsOfAllKindsAddUp) {
  Scene scene;
  scene.lights.push_back({{1, 2, 0}, glm::dvec3(5.0)});
  scene.lights.push_back({{0, 2, 1}, glm::dvec3(9.0), SpotCone{{0, -1, 0}, 10.0, 80.0}});
  scene.directional_lights.push_back({{0.6, -0.8, 0}, glm::vec3(2.0f)});
  add(scene, rectangle({-1, 1.5f, -1}, {0, 0, 1}, {0.5f, 0, 0}), lamp(glm::vec3(3.0f)));
  const double sum = floor_radiance(scene, kWhitted, 1024);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), sum, 0.005 * sum);
}

// A parallel rectangle with one corner straight above (Siegel and Howell's catalogue, B-4).
TEST(Physics, RectangularLampHasItsFormFactor) {
  const double a = 1.5, b = 0.8, height = 1.2;
  Scene scene;
  add(scene, rectangle({0, float(height), 0}, {float(a), 0, 0}, {0, 0, float(b)}),
      lamp(glm::vec3(3.0f)));
  const double x = a / height, y = b / height;
  const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double form = (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
  EXPECT_NEAR(floor_radiance(scene, kWhitted, 4096), 3.0 * form, 3e-4 * form);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), 3.0 * form, 3e-3 * form);
}

// Of a rough floor under a lamp, seen at an angle: the integral over the lamp. Whether lamps are
// asked for or met by chance, wide lobes or narrow ones.
TEST(Physics, FacetsReflectALamp) {
  for (const float roughness : {0.25f, 0.6f, 1.0f}) {
    Material material = facets(0.5f, roughness, 0.0f);
    material.diffuse = glm::vec3(0.8f);
    Scene scene;
    add(scene, rectangle({-1, 2, -2}, {2, 0, 0}, {0, 0, 1.5f}), lamp(glm::vec3(3.0f)));
    add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), material);
    const Camera camera = camera_at({0, 1, 1.5}, {0, 0, 0}, 1e-3);
    RenderOptions options = light(kPath, 1, 1, 4096);
    options.max_depth = 1;
    const Bvh bvh(scene);
    const glm::vec3 eye(camera.eye());
    const Ray ray = {eye, camera.direction(0.5, 0.5)};
    const Finish finish(material);
    const Finish* const finishes[] = {&finish};
    std::uint32_t floor = 0;
    while (!hits_triangle(ray, bvh.corners_of(floor))) ++floor;
    const HitPlace places[] = {{&ray, floor, &scene.triangles[bvh.triangle_of(floor)], nullptr}};
    const HitKind kind = finish.kind | weights_needed(places[0]);
    const Bsdf<float> bsdf(surface_at<float>(scene, bvh, kind, places), kind, finishes);
    double integral = 0.0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      for (int k = 0; k < kSteps; ++k) {
        const glm::dvec3 at(-1 + 2 * (i + 0.5) / kSteps, 2.0, -2 + 1.5 * (k + 0.5) / kSteps);
        const double squared = glm::dot(at, at), cosine = 2.0 / std::sqrt(squared);
        const glm::vec3 way(glm::normalize(at));
        integral += 3.0 * bsdf.scattered({way.x, way.y, way.z}).x * cosine * cosine / squared *
                    (3.0 / kSteps / kSteps);
      }
    }
    EXPECT_NEAR(film_of(scene, camera, options).color[0].r, integral, 0.01 * integral) << roughness;
    options.integrator = kWhitted;
    options.max_depth = 0;
    options.ambient = 0.0;
    EXPECT_NEAR(film_of(scene, camera, options).color[0].r, integral, 0.01 * integral) << roughness;
  }
}

// A disc parallel to the floor, straight above: sin^2 of the angle under which its rim is seen.
TEST(Physics, DiscLampHasItsFormFactor) {
  std::vector<Corners> disc;
  constexpr int kParts = 512;
  const auto rim = [](int i) {
    const double angle = 2 * kPi * i / kParts;
    return glm::vec3(0.7 * std::cos(angle), 1.1, 0.7 * std::sin(angle));
  };
  for (int i = 0; i < kParts; ++i) disc.push_back({glm::vec3(0, 1.1f, 0), rim(i), rim(i + 1)});
  Scene scene;
  add(scene, disc, lamp(glm::vec3(2.0f)));
  const double form = 0.49 / (0.49 + 1.21);
  EXPECT_NEAR(floor_radiance(scene, kWhitted, 4096), 2.0 * form, 1e-3 * form);
  EXPECT_NEAR(floor_radiance(scene, kPath, 4096), 2.0 * form, 4e-3 * form);
}

// A square between a point light and the floor: every pixel is lit just where the line to the
// light passes beside the square.
TEST(Physics, ShadowOfASquareIsWhereItMustBe) {
  Scene scene;
  add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
  add(scene, rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}), matte(glm::vec3(1.0f)));
  const glm::dvec3 lamp(0.7, 3, -0.2), way(-0.3, -1.0, 0.2);
  const Camera camera = camera_at({0, 0.9, 2.5}, {0.2, 0, 0}, 60.0);
  for (const auto& [integrator, is_far] :
       {std::pair(kWhitted, false), {kPath, false}, {kWhitted, true}, {kPath, true}}) {
    scene.lights.clear();
    scene.directional_lights.clear();
    if (is_far) {
      scene.directional_lights.push_back({glm::normalize(way), glm::vec3(1.0f)});
    } else {
      scene.lights.push_back({glm::vec3(lamp), glm::vec3(10.0f)});
    }
    RenderOptions options = light(integrator, 96, 96, 1);
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
                   : lamp + (lamp.y - 1.0) / (lamp.y - point.y) * (point - lamp);
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

// What a mirror shows is what a camera behind it sees, mirrored: the scene without the mirror.
TEST(Physics, AMirrorShowsTheMirroredScene) {
  Scene things;
  add(things, sphere(2, 0.5f, {0.3f, 0.1f, 1.5f}), matte({0.8f, 0.4f, 0.2f}));
  add(things, rectangle({-4, -1, 0.01f}, {8, 0, 0}, {0, 0, 8}), matte(glm::vec3(0.6f)));
  things.lights.push_back({{1, 3, 4}, {20, 20, 20}});
  Scene mirrored = things;
  // In front of all: it fills the view, and hides nothing from the light.
  add(mirrored, rectangle({-50, -1, 0}, {100, 0, 0}, {0, 100, 0}), mirror(1.0f));
  constexpr int kSize = 64;
  const Camera front = camera_at({0.5, 0.6, 4}, {0.2, 0.3, 0}, 30.0);
  const Camera behind = camera_at({0.5, 0.6, -4}, {0.2, 0.3, 0}, 30.0);
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    RenderOptions options = light(integrator, kSize, kSize, 1);
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

// Lengths have no unit: a scene a trillion times as large, or as small, looks the same, to the bit,
// with the light that a scene without one gets.
TEST(Physics, SizeDoesNotMatter) {
  const auto picture = [](float scale, IntegratorKind integrator) {
    Scene scene;
    add(scene, sphere(2, 0.8f * scale), matte(glm::vec3(0.7f)));
    add(scene,
        rectangle(glm::vec3(-2, -1, -2) * scale, glm::vec3(4, 0, 0) * scale,
                  glm::vec3(0, 0, 4) * scale),
        mirror(0.5f));
    const Camera camera = camera_at(glm::dvec3(0.5, 0.7, 4) * double(scale), glm::dvec3(0), 40.0);
    light_if_dark(scene, camera);
    return film_of(scene, camera, light(integrator, 24, 24, 2));
  };
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const Film plain = picture(1.0f, integrator);
    EXPECT_GT(mean_colour(plain).r, 0.1);
    EXPECT_TRUE(same_bytes(plain.color, picture(0x1p40f, integrator).color));
    EXPECT_TRUE(same_bytes(plain.color, picture(0x1p-40f, integrator).color));
  }
}

Material shown(const glm::vec3& colour) {
  Material material = matte(colour);
  material.illumination_model = 0;
  return material;
}

// Through a slab of glass every ray goes on beside itself, by what Snell's law says, and loses
// Fresnel's share at both sides: a red and a green half-plane behind it, unlit.
TEST(Physics, ASlabOfGlassShiftsWhatIsBehindIt) {
  const double index = 1.5, thickness = 1.0;
  Scene scene;
  add(scene, rectangle({-30, -30, -2}, {30, 0, 0}, {0, 60, 0}), shown({1, 0, 0}));
  add(scene, rectangle({0, -30, -2}, {30, 0, 0}, {0, 60, 0}), shown({0, 1, 0}));
  add(scene, box({-20, -20, -float(thickness)}, {20, 20, 0}), glass(float(index)));
  const Camera camera = camera_at({4, 0.3, 3}, {1, 0, 0}, 50.0);
  RenderOptions options = light(kWhitted, 80, 80, 1);
  options.max_depth = 2;  // no light that the glass has reflected inside
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
      const double angle = std::asin(sine), bent = std::asin(inside);
      const double across = std::sin(angle - bent) / std::sin(angle + bent);
      const double parallel = std::tan(angle - bent) / std::tan(angle + bent);
      const double through = 1.0 - 0.5 * (across * across + parallel * parallel);
      const glm::vec4 colour = film.color[std::size_t(y) * 80 + x];
      ASSERT_NEAR(arrives < 0.0 ? colour.r : colour.g, through * through, 1e-6) << x << " " << y;
      ASSERT_EQ(arrives < 0.0 ? colour.g : colour.r, 0.0f) << x << " " << y;
      ++(arrives < 0.0 ? red : green);
    }
  }
  EXPECT_GT(red, 500);
  EXPECT_GT(green, 500);
}

// From under water, beyond the critical angle, the surface is a perfect mirror of the ground;
// before it the sky is seen, too.
TEST(Physics, TotalReflectionShowsTheGround) {
  Scene scene;
  add(scene, rectangle({-90, -2, 90}, {180, 0, 0}, {0, 0, -180}), shown({0.5f, 0.25f, 0}));
  add(scene, rectangle({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}), glass(4.0f / 3.0f));
  scene.background = glm::vec3(0, 0, 1);
  const auto seen = [&](double degrees) {
    const double angle = glm::radians(degrees);
    const Camera camera = camera_at({0, -1, 0}, {std::sin(angle), -1 + std::cos(angle), 0}, 1e-3);
    RenderOptions options = light(kWhitted, 1, 1, 1);
    options.max_depth = 1;
    options.ambient = 0.0;
    return film_of(scene, camera, options).color[0];
  };
  const double critical = glm::degrees(std::asin(0.75));
  for (const double degrees : {critical + 0.1, 60.0, 80.0}) {
    EXPECT_EQ(seen(degrees), glm::vec4(0.5f, 0.25f, 0, 1)) << degrees;
  }
  for (const double degrees : {5.0, 30.0, critical - 0.1}) {
    const double angle = glm::radians(degrees), bent = std::asin(std::sin(angle) * 4.0 / 3.0);
    const double across = std::sin(angle - bent) / std::sin(angle + bent);
    const double parallel = std::tan(angle - bent) / std::tan(angle + bent);
    const double reflected = 0.5 * (across * across + parallel * parallel);
    const glm::vec4 colour = seen(degrees);
    EXPECT_NEAR(colour.r, 0.5 * reflected, 1e-4) << degrees;
    EXPECT_NEAR(colour.b, 1.0 - reflected, 1e-4) << degrees;
  }
}

// Light from a lamp through one or two panes that let half of it through.
TEST(Physics, PanesWeakenLightAndShadowsAlike) {
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
    add(by_area, rectangle({-0.1f, 2, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}), lamp(glm::vec3(9)));
    const double share = std::pow(0.5, panes), point = 1.0 / 4.0 / kPi;
    EXPECT_NEAR(floor_radiance(by_point, kWhitted, 1), share * point, 1e-6);
    EXPECT_NEAR(floor_radiance(by_point, kPath, 1), share * point, 1e-6);
    const float whitted = floor_radiance(by_area, kWhitted, 256);
    if (panes == 0) unweakened = whitted;
    EXPECT_NEAR(whitted, share * unweakened, 1e-6);
    EXPECT_NEAR(floor_radiance(by_area, kPath, 256), whitted, 2e-2 * whitted);
  }
}

// Where no light goes from one scattering surface to another both integrators show the same.
TEST(Physics, PathAndWhittedAgreeAboutDirectLight) {
  Scene scene = everything();
  scene.background = glm::vec3(0.0f);
  scene.materials[4] = matte(glm::vec3(0.5f));  // the glass: its shadows differ
  const Camera camera = camera_at({0.6, 0.2, 5}, {0, -0.3, 0}, 40.0);
  RenderOptions options = light(kWhitted, 24, 24, 256);
  options.max_depth = 0;
  options.ambient = 0.0;
  const glm::dvec3 whitted = mean_colour(film_of(scene, camera, options));
  options.integrator = kPath;
  const glm::dvec3 path = mean_colour(film_of(scene, camera, options));
  // The path's last rays see lamps in the mirror and through the window, where Whitted stops: those
  // are few here.
  EXPECT_NEAR(path.r, whitted.r, 0.02 * whitted.r);
  EXPECT_NEAR(path.g, whitted.g, 0.02 * whitted.g);
}

}  // namespace
}  // namespace raygate
