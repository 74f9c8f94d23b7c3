// Small scenes with materials and lights, and their films; a single surface and its BSDF.
#pragma once

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/test/model_intersector.h"
#include "host/light/bsdf.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"

namespace raygate::test {

inline Material matte(const glm::vec3& diffuse) {
  Material material;
  material.diffuse = diffuse;
  material.illumination_model = 1;
  return material;
}

inline Material mirror(float specular) {
  Material material = matte(glm::vec3(0.0f));
  material.specular = glm::vec3(specular);
  material.illumination_model = 3;
  return material;
}

inline Material glass(float index) {
  Material material = matte(glm::vec3(0.0f));
  material.refraction_index = index;
  material.opacity = 0.0f;
  material.illumination_model = 7;
  return material;
}

inline Material emitter(const glm::vec3& emission) {
  Material material = matte(glm::vec3(0.0f));
  material.emission = emission;
  return material;
}

/// Returns a white material with these metallic-roughness parameters.
inline Material facets(float metallic, float roughness, float transmission) {
  Material material = matte(glm::vec3(1.0f));
  material.metallic_roughness = {metallic, roughness, transmission};
  return material;
}

/// Returns two triangles that form the parallelogram with corner `a` and sides `u` and `v`.
inline std::vector<Corners> rectangle(const glm::vec3& a, const glm::vec3& u, const glm::vec3& v) {
  return {{a, a + u, a + u + v}, {a, a + u + v, a + v}};
}

/// Adds triangles of one material, as an object of their own.
inline void add(Scene& scene, const std::vector<Corners>& triangles, const Material& material) {
  const auto index = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(material);
  scene.objects.push_back("object " + std::to_string(index));
  Scene more = scene_of(triangles);
  for (Triangle triangle : more.triangles) {
    for (auto& vertex : triangle.vertices) {
      vertex += static_cast<std::uint32_t>(scene.positions.size());
    }
    triangle.material = triangle.object = index;
    scene.triangles.push_back(triangle);
  }
  scene.positions.insert(scene.positions.end(), more.positions.begin(), more.positions.end());
}

inline IntersectorFactory pipeline_model(const Bvh& bvh) {
  return [&bvh] { return model_intersector(bvh); };
}
inline IntersectorFactory cpu(const Bvh& bvh) {
  return [&bvh] { return std::make_unique<CpuIntersector>(bvh); };
}
inline IntersectorFactory serial_model(const Bvh& bvh) {
  return [&bvh] {
    return make_unit_intersector(
        bvh, std::make_unique<SerialHitTester>(std::make_unique<ReferencePlaneUnit>()));
  };
}

inline Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                   const RenderSettings& settings, const IntersectorFactory& make_intersector,
                   RenderStats& stats, const RenderMonitor& monitor = {}) {
  const PreparedScene prepared(scene, bvh);
  return raygate::render({prepared, camera, settings}, make_intersector, stats, monitor);
}

inline RenderSettings light(IntegratorKind integrator, int width, int height, int samples) {
  RenderSettings options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  options.integrator = integrator;
  options.max_depth = integrator == IntegratorKind::kPath ? 64 : 4;
  return options;
}

inline Film film_of(const Scene& scene, const Camera& camera, const RenderSettings& options,
                    const std::optional<CameraLights>& lights = {}) {
  RenderStats stats;
  const Bvh bvh(scene);
  const PreparedScene prepared(scene, bvh);
  return raygate::render({prepared, camera, options, lights}, pipeline_model(bvh), stats);
}

/// Returns the mean colour of all pixels.
inline glm::dvec3 mean_colour(const Film& film) {
  glm::dvec3 sum(0.0);
  for (const glm::vec4& colour : film.color) sum += glm::dvec3(colour);
  return sum / static_cast<double>(film.color.size());
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

inline bool same(const Film& a, const Film& b) {
  return same_bytes(a.color, b.color) && same_bytes(a.depth, b.depth) &&
         same_bytes(a.normal, b.normal) && same_bytes(a.primitive, b.primitive);
}

/// Returns a room with an area light, a point light, a mirror, a glass sphere, a glossy sphere, a
/// sphere of rough metal and glass, and a half-transparent window; the sky is seen through a door.
inline Scene everything() {
  Scene scene;
  add(scene, rectangle({-2, -2, -2}, {4, 0, 0}, {0, 0, 4}), matte({0.7f, 0.6f, 0.5f}));
  add(scene, rectangle({-2, -2, -2}, {0, 4, 0}, {4, 0, 0}), matte({0.3f, 0.5f, 0.7f}));
  add(scene, rectangle({-1.9f, -1.5f, -1}, {0.1f, 3, 0}, {0, 0, 2}), mirror(0.9f));
  add(scene, rectangle({-0.5f, 1.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}), emitter({6, 5, 4}));
  add(scene, sphere(2, 0.7f, {-0.8f, -1.2f, 0.3f}), glass(1.5f));
  Material glossy = matte({0.5f, 0.1f, 0.1f});
  glossy.specular = glm::vec3(0.4f);
  glossy.shininess = 30.0f;
  glossy.illumination_model = 2;
  add(scene, sphere(2, 0.6f, {0.9f, -1.3f, -0.7f}), glossy);
  Material window = matte({0.1f, 0.6f, 0.2f});
  window.opacity = 0.4f;
  add(scene, rectangle({0.4f, -1.5f, 0.6f}, {1, 0, 0}, {0, 1.5f, 0.1f}), window);
  add(scene, sphere(2, 0.5f, {0.3f, 0.4f, 0.2f}), facets(0.3f, 0.5f, 0.6f));
  scene.lights.push_back({{1.5f, 1.0f, 1.5f}, {3, 3, 4}});
  scene.background = glm::vec3(0.2f, 0.3f, 0.4f);
  return scene;
}

inline Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target, double fov,
                        double aspect = 1.0) {
  return Camera::look_at({.eye = eye, .target = target, .fov = fov}, aspect);
}

/// Returns a pixel that looks straight down at the origin of a white floor.
inline float floor_radiance(Scene scene, IntegratorKind integrator, int samples) {
  add(scene, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
  const Camera camera = camera_at({0, 1e-3, 0}, {0, 0, 0}, 1e-3);
  RenderSettings options = light(integrator, 1, 1, samples);
  options.max_depth = 0;
  options.ambient = 0.0;
  return film_of(scene, camera, options).color[0].r;
}

inline Triple<float> triple(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// Returns the BSDF of a triangle, seen from outside (or inside) at this angle to +z.
inline Bsdf<float> seen(const Material& material, double angle, bool outside = true) {
  Scene scene = scene_of({{glm::vec3(-9, -9, 0), glm::vec3(9, -9, 0), glm::vec3(0, 9, 0)}});
  if (!outside) std::swap(scene.triangles[0].vertices[0], scene.triangles[0].vertices[1]);
  scene.materials[0] = material;
  const Bvh bvh(scene);
  const glm::vec3 eye(float(2 * std::sin(angle)), 0, float(2 * std::cos(angle)));
  const Ray ray = {eye, scaled_direction(glm::dvec3(-eye))};
  return bsdf_at(scene, bvh, {&ray, 0, scene.triangles.data()}, MaterialParameters(material));
}

/// Returns Fresnel's reflectance of glass, by sines and tangents of angles instead of cosines.
inline double reflectance(double angle, double index = 1.5) {
  const double bent = std::asin(std::sin(angle) / index);
  if (angle < 1e-6) return std::pow((index - 1) / (index + 1), 2);
  const double across = std::sin(angle - bent) / std::sin(angle + bent);
  const double parallel = std::tan(angle - bent) / std::tan(angle + bent);
  return 0.5 * (across * across + parallel * parallel);
}

}  // namespace raygate::test
