#include "host/render/shade.h"

#include <algorithm>

namespace raygate {
namespace {

/// The weights of the vertices at the hit: I . (B x C), I . (C x A), I . (A x B), all of one sign
/// but for rounding, over their sum.
glm::dvec3 barycentric(const Corners& corners, const Ray& ray) {
  const glm::dvec3 direction(ray.direction);
  glm::dvec3 weights;
  for (int k = 0; k < 3; ++k) {
    weights[k] =
        glm::dot(direction, edge_normal(ray.origin, corners[(k + 1) % 3], corners[(k + 2) % 3]));
  }
  if (weights.x + weights.y + weights.z < 0.0) weights = -weights;
  weights = glm::max(weights, glm::dvec3(0.0));
  return weights / (weights.x + weights.y + weights.z);
}

/// The normals of the file at the hit, or the triangle's own; of no particular length or side. A
/// triangle that is hit has an area, so its own normal is never 0.
glm::dvec3 shading_normal(const Scene& scene, const Triangle& triangle, const Corners& corners,
                          const Ray& ray) {
  if (std::ranges::count(triangle.normals, kNoIndex) == 0) {
    const glm::dvec3 weights = barycentric(corners, ray);
    glm::dvec3 normal(0.0);
    for (int k = 0; k < 3; ++k) {
      normal += weights[k] * glm::dvec3(scene.normals[triangle.normals[k]]);
    }
    if (glm::dot(normal, normal) > 0.0) return normal;  // false for NaN, too
  }
  return triangle_normal(corners);
}

}  // namespace

Appearance shade(const Scene& scene, const Triangle& triangle, const Corners& corners,
                 const Ray& ray) {
  const glm::dvec3 view = -glm::normalize(glm::dvec3(ray.direction));
  glm::dvec3 normal = glm::normalize(shading_normal(scene, triangle, corners, ray));
  double cosine = glm::dot(normal, view);
  if (cosine < 0.0) {
    normal = -normal;
    cosine = -cosine;
  }
  const Material& material = scene.materials[triangle.material];
  return {material.diffuse * static_cast<float>(cosine) + material.emission, glm::vec3(normal)};
}

}  // namespace raygate
