// What a hit looks like.
#pragma once

#include <glm/glm.hpp>

#include "host/hit/exact.h"
#include "host/scene/scene.h"

namespace raygate {

struct Appearance {
  glm::vec3 color{0.0f};   ///< scene-linear
  glm::vec3 normal{0.0f};  ///< unit shading normal, towards the viewer
};

/// The look of `triangle` where `ray` hits it, lit from the ray's origin by a light of strength 1
/// that distance does not weaken: diffuse colour times the cosine between normal and ray, on either
/// side, plus emission. Normals of the file, where given, are interpolated.
[[nodiscard]] Appearance shade(const Scene& scene, const Triangle& triangle, const Corners& corners,
                               const Ray& ray);

}  // namespace raygate
