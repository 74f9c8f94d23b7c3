// What all threads of a render read.
#pragma once

#include "host/light/lights.h"
#include "host/light/neighbor_clearance.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"

namespace raygate {

struct RenderJob {
  const Scene& scene;
  const Bvh& bvh;
  const Camera& camera;
  const RenderOptions& options;
  const Lights& lights;
  const NeighborClearances& clearances;
  glm::dvec3 ambient;  ///< as IntegratorOptions has it

  /// What a triangle, or kNone, sends out as a light.
  [[nodiscard]] glm::vec3 emission_of(std::uint32_t primitive) const {
    if (primitive == NearestHit::kNone) return glm::vec3(0.0f);
    return scene.materials[face_at(scene, bvh.face_of(primitive)).material].emission;
  }
};

}  // namespace raygate
