// Compares shadow rays with exact arithmetic on every triangle.
#include "host/light/shadow_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// Returns a sphere, an open box with an inner wall, and point, area and directional lights.
Scene obstacles() {
  Scene scene;
  add(scene, sphere(2), matte(glm::vec3(0.5f)));
  add(scene, box(glm::vec3(-3), glm::vec3(3)), matte(glm::vec3(0.5f)));
  add(scene, rectangle({-3, -3, 1.2f}, {2, 0, 0}, {0, 6, 0}), matte(glm::vec3(0.5f)));
  add(scene, rectangle({-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), emitter(glm::vec3(1.0f)));
  scene.lights.push_back({{2, 2.5f, 2}, glm::vec3(1.0f)});
  scene.lights.push_back({{-2.7f, -1, 2.8f}, glm::vec3(1.0f)});
  scene.directional_lights.push_back({glm::normalize(glm::dvec3(0.3, 0.2, -1)), glm::vec3(1.0f)});
  return scene;
}

class ShadowRaysTest : public testing::Test {
 protected:
  /// Adds shadow rays from surface points seen from `eye` to all lights in front of the surface.
  void add_questions(const glm::vec3& eye, int count) {
    RaySpawner spawner(prepared_.clearances);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
      rays.push_back({eye, scaled_direction(glm::dvec3(random_.point()) - 1e-9)});
    }
    std::vector<NearestHit> hits(rays.size());
    intersector_->nearest(rays, {}, hits);
    for (int i = 0; i < count; ++i) {
      const std::uint32_t primitive = hits[i].primitive;
      if (primitive == NearestHit::kNone) continue;
      const auto origin = spawner.find(rays[i], primitive, SpawnSide::kIncident);
      if (!origin) continue;
      ShadowRay ray;
      ray.radiance = glm::vec3(1.0f);
      ray.surface = *origin;
      ray.surface_primitive = primitive;
      const int side = orient3d(eye, bvh_.corners_of(primitive));
      const auto ask = [&](const glm::vec3& at) {
        if (orient3d(at, bvh_.corners_of(primitive)) == side) questions_.push_back(ray);
      };
      ray.is_point_light = 1;
      for (ray.index = 0; ray.index < 2; ++ray.index) ask(scene_.lights[ray.index].position);
      ray.is_point_light = 0;
      const LightPoint<float> point = lights_.sample<float>(
          lights_.light(2), {float(random_.uniform(0, 1)), float(random_.uniform(0, 1))});
      ray.target = {point.position.x, point.position.y, point.position.z};
      ray.index = point.primitive;
      ask(ray.target);
      ray.target = glm::vec3(-scene_.directional_lights[0].direction);
      ray.index = NearestHit::kNone;
      if (direction_side(ray.target, bvh_.corners_of(primitive)) == -side)
        questions_.push_back(ray);
    }
  }

  /// Returns whether, in exact arithmetic, a triangle is between the surface point and the light.
  bool is_blocked(const ShadowRay& question) const {
    const bool is_point = question.is_point_light != 0;
    if (!is_point && question.index == NearestHit::kNone) return is_blocked_from_afar(question);
    const glm::vec3 target = is_point ? scene_.lights[question.index].position : question.target;
    const glm::dvec3 way = glm::dvec3(target) - glm::dvec3(question.surface);
    const Ray ray = {question.surface, scaled_direction(way)};
    const glm::dvec3 scaled(ray.direction);
    const double share = is_point ? 1.0 : 1.0 - 0x1p-16;
    const auto limit =
        static_cast<float>(share * std::sqrt(glm::dot(way, way) / glm::dot(scaled, scaled)));
    for (std::uint32_t primitive = 0; primitive < bvh_.primitive_count(); ++primitive) {
      if (!is_point && primitive == question.index) continue;
      const Corners& t = bvh_.corners_of(primitive);
      if (hits_triangle(ray, t) && compare_hit_to_limit(ray, t, limit) < 0) return true;
    }
    return false;
  }

  bool is_blocked_from_afar(const ShadowRay& question) const {
    const Ray ray = {question.surface, scaled_direction(glm::dvec3(question.target))};
    for (std::uint32_t primitive = 0; primitive < bvh_.primitive_count(); ++primitive) {
      if (hits_triangle(ray, bvh_.corners_of(primitive))) return true;
    }
    return false;
  }

  Scene scene_ = obstacles();
  Bvh bvh_{scene_};
  PreparedScene prepared_{scene_, bvh_};
  Lights lights_{scene_, bvh_};
  std::unique_ptr<Intersector> intersector_ = model_intersector(bvh_);
  Random random_;
  std::vector<ShadowRay> questions_;
};

TEST_F(ShadowRaysTest, DecideAsExactArithmeticDoes) {
  for (const glm::vec3& eye : {glm::vec3(2, -1, 1.9f), glm::vec3(-2.5f, 2, -2.2f)}) {
    add_questions(eye, 2000);
  }
  ShadowRays(prepared_, lights_, *intersector_, true).resolve(questions_);
  int dark = 0, lit = 0, different = 0;
  for (const ShadowRay& answer : questions_) {
    const bool blocked = is_blocked(answer);
    ++(blocked ? dark : lit);
    different += blocked != (answer.radiance == glm::vec3(0.0f));
  }
  EXPECT_GT(dark, 1000);
  EXPECT_GT(lit, 1000);
  // Rays from the light and from the surface are rounded differently. Where an edge is less than a
  // float step from the rays, either answer is right.
  EXPECT_LE(different, 2);
  std::cout << dark << " dark, " << lit << " lit, " << different << " different\n";
}

// Light through holes of masks, transparent surfaces and glass is the same with all intersectors.
TEST(ShadowRays, PassHolesOfMasks) {
  Random random;
  Scene scene;
  std::vector<Texture::Texel> texels;
  for (int i = 0; i < 32 * 32; ++i) {
    const bool is_there = (i / 4 + i / 128) % 2 != 0;
    texels.push_back(is_there ? Texture::Texel{255, 255, 255} : Texture::Texel{});
  }
  scene.textures.emplace_back(32, 32, texels);
  Material leaf = matte(glm::vec3(0.5f)), veil = matte(glm::vec3(0.5f));
  leaf.opacity_map.texture = 0;
  veil.opacity = 0.5f;
  scene.texcoords = {{0, 0}, {1, 0}, {1, 1}};
  const auto add_some = [&](int count, const Material& material) {
    std::vector<Corners> faces;
    for (int i = 0; i < count; ++i) {
      const glm::vec3 at = random.point(4.0f);
      faces.push_back({at, at + random.point(), at + random.point()});
    }
    add(scene, faces, material);
  };
  add_some(1500, leaf);
  for (Triangle& face : scene.triangles) face.texcoords = {0, 1, 2};
  add_some(100, veil);
  add_some(100, matte(glm::vec3(0.5f)));
  add_some(100, glass(1.5f));
  const Bvh bvh(scene);
  const PreparedScene prepared{scene, bvh};
  const Lights lights(scene, bvh);
  std::vector<ShadowRay> asked(20000);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    asked[i].radiance = glm::vec3(1.0f);
    asked[i].surface = random.point(4.5f);
    asked[i].surface_primitive = NearestHit::kNone;
    asked[i].target = i % 2 == 0 ? random.point(4.5f) : random.point();
    asked[i].index = i % 2 == 0 ? 0 : NearestHit::kNone;
  }
  const auto answers = [&](Intersector& intersector) {
    std::vector<ShadowRay> rays = asked;
    ShadowRays(prepared, lights, intersector, false).resolve(rays);
    return rays;
  };
  CpuIntersector cpu(bvh);
  const std::vector<ShadowRay> found = answers(cpu), expected = answers(*model_intersector(bvh));
  int lit = 0, veiled = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    ASSERT_EQ(found[i].radiance, expected[i].radiance) << i;
    lit += expected[i].radiance == glm::vec3(1.0f) ? 1 : 0;
    veiled += expected[i].radiance.r > 0.0f && expected[i].radiance.r < 1.0f ? 1 : 0;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(veiled, 100);
}

}  // namespace
}  // namespace raygate
