#include "host/light/surface.h"

#include "host/scene/texture.h"

namespace raygate {

glm::vec3 textured(const Scene& scene, const Triangle& face, const glm::vec3& weights) {
  return diffuse_at(scene, face, glm::dvec3(weights));
}

glm::vec2 textured_roughness(const Scene& scene, const Triangle& face, const glm::vec3& weights) {
  return roughness_at(scene, face, glm::dvec3(weights));
}

}  // namespace raygate
