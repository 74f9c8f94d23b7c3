#include "host/light/surface.h"

#include <algorithm>

#include "host/scene/texture.h"

namespace raygate {

/// I . (B x C), I . (C x A), I . (A x B), all of one sign but for rounding, over their sum.
glm::dvec3 barycentric(const Corners& corners, const Ray& ray) {
  const glm::dvec3 direction(ray.direction);
  glm::dvec3 weights;
  for (int k = 0; k < 3; ++k) {
    weights[k] =
        glm::dot(direction, edge_normal(ray.origin, corners[(k + 1) % 3], corners[(k + 2) % 3]));
  }
  if (weights.x + weights.y + weights.z < 0.0) weights = -weights;
  weights = glm::max(weights, glm::dvec3(0.0));
  const double sum = weights.x + weights.y + weights.z;
  return sum > 0.0 ? weights / sum : glm::dvec3(1.0 / 3.0);
}

glm::dvec3 file_normal(const Scene& scene, const Triangle& triangle, const Corners& corners,
                       const glm::dvec3& weights) {
  if (std::ranges::count(triangle.normals, kNoIndex) == 0) {
    glm::dvec3 normal(0.0);
    for (int k = 0; k < 3; ++k) {
      normal += weights[k] * glm::dvec3(scene.normals[triangle.normals[k]]);
    }
    if (glm::dot(normal, normal) > 0.0) return normal;  // false for NaN, too
  }
  return triangle_normal(corners);
}

Surface::Surface(const Scene& scene, const Bvh& bvh, const Ray& ray, std::uint32_t hit_slot,
                 const glm::vec3* unit_point)
    : slot(hit_slot), triangle(bvh.triangle_of(hit_slot)) {
  const Corners& corners = bvh.corners_of(slot);
  const Triangle& face = scene.triangles[triangle];
  material = &scene.materials[face.material];
  const bool uses_weights = unit_point == nullptr ||
                            std::ranges::count(face.normals, kNoIndex) == 0 ||
                            material->diffuse_texture != kNoIndex;
  const glm::dvec3 weights = uses_weights ? barycentric(corners, ray) : glm::dvec3(1.0 / 3.0);
  point = unit_point != nullptr
              ? glm::dvec3(ray.origin) + glm::dvec3(*unit_point)
              : weights.x * glm::dvec3(corners[0]) + weights.y * glm::dvec3(corners[1]) +
                    weights.z * glm::dvec3(corners[2]);
  diffuse = glm::dvec3(diffuse_at(scene, face, weights));
  view = -glm::normalize(glm::dvec3(ray.direction));

  flat_normal = glm::normalize(triangle_normal(corners));
  normal = glm::normalize(file_normal(scene, face, corners, weights));
  if (glm::dot(flat_normal, normal) < 0.0) flat_normal = -flat_normal;
  // Exactly, as at grazing angles the product of view and normal may have either sign.
  const bool along = glm::dot(flat_normal, triangle_normal(corners)) > 0.0;
  outside = (direction_side(ray.direction, corners) < 0) == along;
  if (!outside) {
    flat_normal = -flat_normal;
    normal = -normal;
  }
  const double facing = glm::dot(normal, view);
  if (facing < 0.0) {
    const glm::dvec3 tilted = normal - facing * view;
    normal = glm::dot(tilted, tilted) > 0.0 ? glm::normalize(tilted) : flat_normal;
  }
}

}  // namespace raygate
