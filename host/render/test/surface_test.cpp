// Tests features besides scattering (masks, normal maps, shadow catchers), and scenes of any size.
#include <gtest/gtest.h>

#include <cmath>

#include "host/light/lights.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

using enum IntegratorKind;

// A shadow catcher looks like the background, but darker where something blocks the light.
TEST(Surface, AShadowCatcherIsSeenWhereItsShadowsAre) {
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

/// Adds a square at z = 0 from -1 to 1, with texture coordinates from 0 to 1.
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

/// Returns a grey material with the first texture as its mask.
Material masked() {
  Material material = matte(glm::vec3(0.5f));
  material.opacity_map.texture = 0;
  material.opacity_map.mapping.sampling = Wrap::kClamp;
  return material;
}

/// Adds squares that a mask hides, one behind the other.
void add_hidden(Scene& scene, int squares) {
  scene.textures.emplace_back(1, 1, std::vector<Texture::Texel>{{0, 0, 0}});
  for (int i = 0; i < squares; ++i) {
    const std::size_t first = scene.positions.size();
    add_picture(scene, masked());
    for (std::size_t k = first; k < scene.positions.size(); ++k) {
      scene.positions[k].z += 0.1f * static_cast<float>(i);
    }
  }
}

// What a mask hides is missing for camera rays and for shadow rays.
TEST(Surface, AMaskHidesHalfOfASquare) {
  const auto scene_with = [&](bool has_square) {
    Scene scene;
    std::vector<Texture::Texel> texels(8, {0, 0, 0});
    std::fill_n(texels.begin() + 4, 4, Texture::Texel{255, 255, 255});
    scene.textures.emplace_back(8, 1, texels);
    add(scene, rectangle({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), matte(glm::vec3(0.8f)));
    if (has_square) add_picture(scene, masked());
    scene.lights.push_back({{0, 0, 9}, glm::dvec3(80.0)});
    scene.background = glm::vec3(0.1f);
    return scene;
  };
  const Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 25.0);
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const RenderSettings options = light(integrator, 40, 40, integrator == kPath ? 64 : 1);
    const Film with = film_of(scene_with(true), camera, options);
    const Film without = film_of(scene_with(false), camera, options);
    int hidden = 0, seen = 0;
    for (int y = 8; y < 32; ++y) {
      for (int x = 9; x < 31; ++x) {
        const auto i = static_cast<std::size_t>(40 * y + x);
        const float difference = std::abs(with.color[i].g - without.color[i].g);
        if (x < 19 && integrator == kWhitted) {
          ASSERT_LT(difference, 1e-5f) << x << " " << y;
          ++hidden;
        } else if (x > 20) {
          ASSERT_GT(difference, 0.01f) << x << " " << y;
          ASSERT_GE(with.primitive[i], 2u);
          ++seen;
        }
      }
    }
    EXPECT_TRUE(integrator == kPath || hidden > 200);
    EXPECT_GT(seen, 200);
  }
}

// Any number of masked-out surfaces one behind the other still shows what is behind them.
TEST(Surface, ManyMasksHideNothing) {
  const auto center = [&](int squares, IntegratorKind integrator) {
    Scene scene;
    add(scene, rectangle({-3, -3, -1}, {3, 0, 0}, {0, 6, 0}), matte(glm::vec3(0.8f)));
    add(scene, rectangle({0, -3, -1}, {3, 0, 0}, {0, 6, 0}),
        integrator == kWhitted ? emitter(glm::vec3(1.0f)) : matte(glm::vec3(0.8f)));
    add_hidden(scene, squares);
    scene.lights.push_back({{0, 0, 9}, glm::dvec3(80.0)});
    RenderSettings options = light(integrator, 1, 1, integrator == kPath ? 256 : 4);
    options.ambient = 0.0;
    return film_of(scene, camera_at({0, 0, 6}, {0, 0, 0}, 1e-2), options).color[0].r;
  };
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    EXPECT_NEAR(center(9, integrator), center(0, integrator), 1e-4f);
  }
}

// Every channel shows the surface behind holes, or that there is none.
TEST(Surface, ChannelsShowWhatIsBehindHoles) {
  const auto film_with = [&](int squares, IntegratorKind integrator) {
    Scene scene;
    add(scene, rectangle({-3, -3, -2}, {3, 0, 1}, {0, 6, 0}), matte({0.2f, 0.4f, 0.8f}));
    add_hidden(scene, squares);
    scene.lights.push_back({{0, 0, 9}, glm::dvec3(80.0)});
    RenderSettings options = light(integrator, 9, 8, 4);
    options.channels = {.position = true, .albedo = true, .object = true};
    return film_of(scene, camera_at({0, 0, 6}, {0, 0, 0}, 12.0), options);
  };
  for (const auto integrator : {IntegratorKind::kPrimary, kWhitted, kPath}) {
    const Film with = film_with(3, integrator), without = film_with(0, integrator);
    EXPECT_EQ(with.primitive, without.primitive);
    EXPECT_EQ(with.object, without.object);
    for (std::size_t i = 0; i < with.color.size(); ++i) {
      const auto near = [](const auto& a, const auto& b) { return glm::distance(a, b) < 1e-4f; };
      EXPECT_TRUE(with.depth[i] == without.depth[i] ||
                  std::abs(with.depth[i] - without.depth[i]) < 1e-4f);
      EXPECT_TRUE(near(with.normal[i], without.normal[i]));
      EXPECT_TRUE(near(with.position[i], without.position[i]));
      EXPECT_TRUE(near(with.albedo[i], without.albedo[i]));
      EXPECT_EQ(with.color[i].a, without.color[i].a);
      if (integrator == IntegratorKind::kPrimary) {
        EXPECT_TRUE(near(with.color[i], without.color[i]));
      }
    }
  }
}

// A blending texture covers a fraction of the surfaces behind it, for camera and shadow rays.
TEST(Surface, OpacityOfATextureBlends) {
  for (const bool is_unlit : {false, true}) {
    Material veil = is_unlit ? matte(glm::vec3(0.5f)) : facets(0.0f, 0.6f, 0.0f);
    if (is_unlit) veil.illumination_model = 0;
    veil.opacity_map.texture = 0;
    veil.opacity_blends = true;
    const auto center = [&](std::uint8_t code, IntegratorKind integrator, double behind) {
      Scene scene;
      scene.textures.emplace_back(1, 1, std::vector<Texture::Texel>{{code, code, code}});
      add(scene, rectangle({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), matte(glm::vec3(float(behind))));
      add_picture(scene, veil);
      scene.lights.push_back({{0, 0, 9}, glm::dvec3(80.0)});
      const Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 1e-2);
      RenderSettings options = light(integrator, 1, 1, integrator == kPath ? 16384 : 1);
      options.ambient = 0.0;
      options.max_depth = 1;
      return film_of(scene, camera, options).color[0].r;
    };
    for (const IntegratorKind integrator : {kWhitted, kPath}) {
      if (is_unlit && integrator == kPath) continue;  // the wall reflects that light, too
      const double veiled = center(255, integrator, 0.8), bare = center(0, integrator, 0.8);
      EXPECT_GT(std::abs(veiled - bare), 0.05);
      const double a = 51 / 255.0, half = center(51, integrator, 0.8);
      // The texture weakens both the view of the wall and the light on the wall.
      EXPECT_NEAR(half, a * veiled + (1 - a) * (1 - a) * bare, 0.02 * half) << is_unlit;
    }
  }
}

// Interpolated vertex colours multiply the material's, with instances and flattened.
TEST(Surface, ColoursOfVerticesAreBetweenThem) {
  Scene scene;
  add_picture(scene, matte({0.5f, 1.0f, 1.0f}));
  scene.colors = {{1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}};
  scene.background = glm::vec3(1.0f);
  const Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 15.0);
  RenderSettings options = light(kWhitted, 5, 5, 1);
  options.channels.albedo = true;
  const Film film = film_of(scene, camera, options);
  const float half = 6.0f * std::tan(7.5f * 3.14159265f / 180.0f);
  for (std::size_t x = 0; x < 5; ++x) {
    const float at = half * (2.0f * (static_cast<float>(x) + 0.5f) / 5.0f - 1.0f);
    const glm::vec3 wanted(0.5f, 0.5f + 0.5f * at, 0.0f);
    EXPECT_LT(glm::length(film.albedo[10 + x] - wanted), 1e-5f) << x;
  }
  scene.materials[0].has_vertex_colors = false;
  EXPECT_EQ(film_of(scene, camera, options).albedo[12], glm::vec3(0.5f, 1.0f, 1.0f));
}

// A map that tilts normals along u turns the normal to where u increases.
TEST(Surface, ANormalMapTurnsTheNormal) {
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

// Lengths have no unit: a scene 10^12 times as large or as small gives the same picture, to the
// bit, with default lights.
TEST(Surface, SizeDoesNotMatter) {
  const auto picture = [](float scale, IntegratorKind integrator) {
    Scene scene;
    add(scene, sphere(2, 0.8f * scale), matte(glm::vec3(0.7f)));
    add(scene,
        rectangle(glm::vec3(-2, -1, -2) * scale, glm::vec3(4, 0, 0) * scale,
                  glm::vec3(0, 0, 4) * scale),
        mirror(0.5f));
    const Camera camera = camera_at(glm::dvec3(0.5, 0.7, 4) * double(scale), glm::dvec3(0), 40.0);
    return film_of(scene, camera, light(integrator, 24, 24, 2), default_lights(scene, camera));
  };
  for (const IntegratorKind integrator : {kWhitted, kPath}) {
    const Film plain = picture(1.0f, integrator);
    EXPECT_GT(mean_colour(plain).r, 0.1);
    EXPECT_TRUE(same_bytes(plain.color, picture(0x1p40f, integrator).color));
    EXPECT_TRUE(same_bytes(plain.color, picture(0x1p-40f, integrator).color));
  }
}

}  // namespace
}  // namespace raygate
