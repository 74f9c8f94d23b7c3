// Everything that a picture may depend on changes a scene's digest.
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "host/scene/test/instanced_scene.h"

namespace raygate {
namespace {

Scene sample() {
  test::Random random;
  Scene scene = test::instanced_scene(random, 3);
  scene.materials.resize(2);
  scene.materials[1].metallic_roughness.emplace();
  scene.colors.assign(1, glm::vec3(0.5f));
  scene.textures.emplace_back(2, 1, std::vector<Texture::Texel>{{1, 2, 3}, {4, 5, 6}});
  scene.lights.push_back({.spot = SpotCone{}});
  scene.directional_lights.emplace_back();
  scene.environment = EnvironmentMap{.width = 1, .height = 1, .texels = {glm::vec3(1)}};
  return scene;
}

TEST(Digest, IsTheSameOfEqualScenes) {
  Scene scene = sample();
  EXPECT_EQ(digest_of(scene), digest_of(sample()));
  EXPECT_EQ(digest_of(scene).find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(digest_of(scene).size(), 16u);
  // No pixel depends on these members.
  scene.warnings.emplace_back("a.obj:1: said");
  scene.files.emplace_back("a.obj");
  scene.materials[0].name = "another";
  scene.camera = CameraSetting{};
  EXPECT_EQ(digest_of(scene), digest_of(sample()));
}

TEST(Digest, IsAnotherOfScenesThatDiffer) {
  std::vector<std::function<void(Scene&)>> changes = {
      [](Scene&) {},
      [](Scene& s) { s.positions[0].x += 1; },
      [](Scene& s) { s.positions[0].x = s.positions[0].x == 0.0f ? -0.0f : 1e-45f; },
      [](Scene& s) { s.positions.emplace_back(0.0f); },
      [](Scene& s) { s.normals[0] = -s.normals[0]; },
      [](Scene& s) { s.texcoords.emplace_back(0.0f); },
      [](Scene& s) { s.second_texcoords.emplace_back(0.0f); },
      [](Scene& s) { s.tangents.emplace_back(0.0f); },
      [](Scene& s) { s.opacities.emplace_back(0.5f); },
      [](Scene& s) { std::swap(s.triangles[0].vertices[0], s.triangles[0].vertices[1]); },
      [](Scene& s) { s.triangles[0].material = 1; },
      [](Scene& s) { s.meshes[0].positions[0].y += 1; },
      [](Scene& s) { s.meshes[0].triangles.pop_back(); },
      [](Scene& s) { s.instances[0].rows[2][3] += 1e-9; },
      [](Scene& s) { s.instances[0].mesh ^= 1; },
      [](Scene& s) { s.instances[0].object += 1; },
      [](Scene& s) { s.materials[0].diffuse.g = 0.5f; },
      [](Scene& s) { s.materials[0].opacity_blends = true; },
      [](Scene& s) { s.materials[1].metallic_roughness->specular_map.texture = 0; },
      [](Scene& s) { s.materials[0].illumination_model = 1; },
      [](Scene& s) { s.materials[0].diffuse_map.texture = 0; },
      [](Scene& s) { s.materials[0].diffuse_map.mapping.sampling = Wrap::kClamp; },
      [](Scene& s) { s.materials[0].normal_scale = 2.0f; },
      [](Scene& s) { s.materials[0].opacity_map.texture = 0; },
      [](Scene& s) { s.materials[1].metallic_roughness->roughness = 0.5f; },
      [](Scene& s) { s.materials[1].metallic_roughness->roughness_map.texture = 0; },
      [](Scene& s) { s.materials[1].metallic_roughness.reset(); },
      [](Scene& s) {
        s.textures[0] = Texture(2, 1, {{1, 2, 3}, {4, 5, 7}});
      },
      [](Scene& s) {
        s.textures[0] = Texture(1, 2, {{1, 2, 3}, {4, 5, 6}});
      },
      [](Scene& s) { s.objects.push_back("more"); },
      [](Scene& s) { s.lights[0].intensity.r = 1.0; },
      [](Scene& s) { s.lights[0].spot->outer = 44.0; },
      [](Scene& s) { s.lights[0].spot.reset(); },
      [](Scene& s) { s.directional_lights[0].irradiance.b = 1.0f; },
      [](Scene& s) { s.background.r = 0.25f; },
      [](Scene& s) { s.environment->texels[0].r = 2.0f; },
      [](Scene& s) { s.environment->strength = 2.0f; },
      [](Scene& s) { s.environment->ahead.x = 0.5; },
      [](Scene& s) { s.environment.reset(); },
      [](Scene& s) { s.origin.z = 1e-12; },
      [](Scene& s) { s.colors[0].r = 0.25f; },
      [](Scene& s) { s.meshes[0].colors.assign(1, glm::vec3(0.5f)); },
      [](Scene& s) { s.lights[0].position.x = 1.0f; },
      [](Scene& s) { s.lights[0].spot->axis.x = 1.0; },
      [](Scene& s) { s.lights[0].spot->inner = 1.0; },
      [](Scene& s) { s.directional_lights[0].direction.x = 1.0; },
      [](Scene& s) { s.environment->up.x = 0.5; },
      [](Scene& s) { s.environment->width = 2; },
      [](Scene& s) { s.environment->height = 2; },
  };
  using Change = std::function<void(Material&)>;
  for (const Change& change : std::initializer_list<Change>{
           [](Material& m) { m.specular.g = 0.5f; },
           [](Material& m) { m.emission.g = 0.5f; },
           [](Material& m) { m.transmittance.g = 0.5f; },
           [](Material& m) { m.shininess = 2.0f; },
           [](Material& m) { m.refraction_index = 1.25f; },
           [](Material& m) { m.opacity = 0.25f; },
           [](Material& m) { m.diffuse_map.mapping.scale.y = 2.0f; },
           [](Material& m) { m.diffuse_map.mapping.offset.y = 2.0f; },
           [](Material& m) { m.diffuse_map.mapping.sampling = Wrap::kMirror; },
           [](Material& m) { m.diffuse_map.mapping.sampling.is_nearest = true; },
           [](Material& m) { m.diffuse_map.mapping.turn.y = 1.0f; },
           [](Material& m) { m.diffuse_map.mapping.is_second = true; },
           [](Material& m) { m.has_vertex_opacity = true; },
           [](Material& m) { m.normal_map.texture = 0; },
           [](Material& m) { m.normal_map.mapping.sampling = Wrap::kClamp; },
           [](Material& m) { m.opacity_map.mapping.sampling = Wrap::kClamp; },
           [](Material& m) { m.opacity_cutoff = 0.25f; },
           [](Material& m) { m.emission_map.texture = 0; },
           [](Material& m) { m.has_vertex_colors = false; },
           [](Material& m) { m.metallic_roughness->metallic = 0.5f; },
           [](Material& m) { m.metallic_roughness->transmission = 0.5f; },
           [](Material& m) { m.metallic_roughness->specular = 0.5f; },
           [](Material& m) { m.metallic_roughness->specular_color.g = 0.5f; },
           [](Material& m) { m.metallic_roughness->roughness_map.mapping.sampling = Wrap::kClamp; },
           [](Material& m) { m.metallic_roughness->transmission_map.texture = 0; },
           [](Material& m) { m.metallic_roughness->specular_color_map.texture = 0; }}) {
    changes.push_back([change](Scene& s) { change(s.materials[1]); });
  }
  std::set<std::string> seen;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = sample();
    changes[i](scene);
    EXPECT_TRUE(seen.insert(digest_of(scene)).second) << "change " << i;
  }
}

}  // namespace
}  // namespace raygate
