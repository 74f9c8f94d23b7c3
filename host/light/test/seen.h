// One surface and its BSDF.
#pragma once

#include <cmath>
#include <utility>

#include "host/exact/test/meshes.h"
#include "host/light/bsdf.h"

namespace raygate::test {

inline Triple<float> triple(const glm::dvec3& v) { return {float(v.x), float(v.y), float(v.z)}; }

/// A triangle of this material seen at an angle to +z, where its outside is, or its inside.
inline Bsdf<float> seen(const Material& material, double angle, bool outside = true) {
  Scene scene = scene_of({{glm::vec3(-9, -9, 0), glm::vec3(9, -9, 0), glm::vec3(0, 9, 0)}});
  if (!outside) std::swap(scene.triangles[0].vertices[0], scene.triangles[0].vertices[1]);
  scene.materials[0] = material;
  const Bvh bvh(scene);
  const glm::vec3 eye(float(2 * std::sin(angle)), 0, float(2 * std::cos(angle)));
  const Ray ray = {eye, scaled_direction(glm::dvec3(-eye))};
  const SurfaceHit places[] = {{&ray, 0, scene.triangles.data(), nullptr}};
  const MaterialParameters parameters(material);
  const MaterialParameters* const materials[] = {&parameters};
  const HitKind kind = parameters.kind | weights_needed(scene, places[0]);
  return {surface_at<float>(scene, bvh, kind, places), kind, materials};
}

}  // namespace raygate::test
