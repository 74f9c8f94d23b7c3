#include "host/light/surface.h"

#include <cmath>

#include "host/scene/material_lookup.h"

namespace raygate {

glm::vec3 textured(const Scene& scene, const Triangle& face, const glm::vec3& weights) {
  return diffuse_at(scene, face, glm::dvec3(weights));
}

glm::vec2 textured_roughness(const Scene& scene, const Triangle& face, const glm::vec3& weights) {
  return roughness_at(scene, face, glm::dvec3(weights));
}

glm::vec3 bent_normal(const Scene& scene, const Triangle& face, const Corners& corners,
                      const glm::vec3& weights, const glm::vec3& normal) {
  return mapped_normal(scene, face, {corners[0], corners[1], corners[2]}, glm::dvec3(weights),
                       normal);
}

bool is_masked_out(const Scene& scene, const Bvh& bvh, const SurfaceHit& place) {
  const Corners corners = bvh.corners_of(place.primitive);
  const auto wide = [](const glm::vec3& v) { return Triple<double>{v.x, v.y, v.z}; };
  const Triple<double> at =
      unscaled_weights<double>(wide(place.ray->origin), wide(place.ray->direction),
                               {wide(corners[0]), wide(corners[1]), wide(corners[2])});
  const double sum = at.x + at.y + at.z;
  const glm::dvec3 weights = glm::dvec3(at.x, at.y, at.z) / sum;
  return std::isfinite(weights.x + weights.y + weights.z) &&
         is_masked_out(scene, *place.face, weights);
}

}  // namespace raygate
