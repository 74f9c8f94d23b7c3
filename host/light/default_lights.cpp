#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "host/exact/exact.h"
#include "host/light/lights.h"
#include "host/scene/bounds.h"
#include "host/scene/camera.h"
#include "host/scene/material_lookup.h"

namespace raygate {
namespace {

bool has_lights(const Scene& scene) {
  return !scene.lights.empty() || !scene.directional_lights.empty() || scene.environment;
}

/// Returns whether some triangle emits without a texture, so that it is meant as a light.
bool has_emitter(const Scene& scene) {
  return std::ranges::any_of(scene.triangles, [&](const Triangle& face) {
    const Material& material = scene.materials[face.material];
    return !is_left_out(face) && emits(material) && material.emission_map.texture == kNoIndex;
  });
}

/// Returns whether emissive triangles light the scene. Glowing labels, screens and the like do not.
/// `size` is the scene's diagonal.
bool is_lit_by_emitters(const Scene& scene, double size) {
  // Thresholds of radiance * area / size^2: about 1/100 of the main light, or 1/6 for emission with
  // a texture, which is meant to be looked at.
  constexpr double kGlow = 0.01, kPicture = 0.15;
  std::vector<double> radiance;
  for (const Material& material : scene.materials) {
    const bool is_picture = material.emission_map.texture != kNoIndex;
    radiance.push_back(mean(mean_emission(scene, material)) / (is_picture ? kPicture : kGlow));
  }
  double sum = 0.0;
  for (const Triangle& face : scene.triangles) {
    if (radiance[face.material] == 0.0) continue;
    const auto& [a, b, c] = face.vertices;
    const Corners corners{scene.vertex(a), scene.vertex(b), scene.vertex(c)};
    sum += 0.5 * radiance[face.material] * glm::length(triangle_normal(corners));
  }
  return sum > size * size;
}

constexpr glm::vec3 kDimSky(0.18f, 0.2f, 0.24f);

}  // namespace

std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera,
                                           bool is_preview) {
  if (is_empty(scene) || has_lights(scene)) return {};
  const bool is_dark = scene.background == glm::vec3(0.0f);
  if (!is_preview && (!is_dark || has_emitter(scene))) return {};
  const auto [low, high] = position_bounds(scene);
  const glm::dvec3 eye(camera.eye()), middle = 0.5 * (low + high);
  const double size = glm::length(high - low);
  if (is_lit_by_emitters(scene, size)) return {};
  CameraLights lights;
  lights.background = is_preview && !is_dark ? scene.background : kDimSky;
  // `radiance` is that of a facing white wall at `distance`.
  const auto add = [&](const glm::dvec3& at, double distance, double radiance) {
    lights.points.push_back({glm::vec3(glm::clamp(at, -kMostCoordinate, kMostCoordinate)),
                             glm::dvec3(radiance * std::numbers::pi * distance * distance)});
  };
  if (glm::all(glm::lessThanEqual(low, eye)) && glm::all(glm::lessThanEqual(eye, high))) {
    add(eye, 0.35 * size, 0.8);
    return lights;
  }
  const auto add_far = [&](double right, double up, double radiance) {
    constexpr double kFar = 4.0;  // all parts of the scene are at about the same distance
    const glm::dvec3 at =
        middle + kFar * size * (up * camera.up() + right * camera.right() - 1.3 * camera.forward());
    add(at, glm::length(at - middle), radiance);
  };
  // Together with the sky and interreflection, white stays below 1.
  add_far(-0.8, 1.2, is_preview ? 0.4 : 0.6);
  if (is_preview) add_far(1.4, 0.3, 0.16);
  lights.radius = 0.5 * size;  // penumbras are 1/8 as wide as the occluder's distance
  return lights;
}

}  // namespace raygate
