#include "host/scene/io/gltf_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace raygate {
namespace {

constexpr double kLumensPerWatt = 683.0;

}  // namespace

void GltfLights::add(const tinygltf::Light& light, const glm::dmat4& world) {
  glm::dvec3 intensity(light.intensity / kLumensPerWatt);
  for (int k = 0; k < 3 && light.color.size() == 3; ++k) {
    intensity[k] *= light.color[static_cast<std::size_t>(k)];
  }
  for (int k = 0; k < 3; ++k) {
    if (!(intensity[k] >= 0.0 && intensity[k] <= std::numeric_limits<float>::max())) {
      file_.fail("a light's intensity: expected no negative number within the range of float");
    }
  }
  const double length = glm::length(glm::dvec3(world[2]));
  const bool is_directional = light.type == "directional", is_spot = light.type == "spot";
  if ((is_directional || is_spot) && !(length > 0.0 && std::isfinite(length))) {
    return file_.warn_once("a light without a direction is left out", scene_.warnings);
  }
  const glm::dvec3 direction = -glm::dvec3(world[2]) / length;
  if (is_directional) {
    scene_.directional_lights.push_back({direction, glm::vec3(intensity)});
    return;
  }
  PlacedLight& placed = lights_.emplace_back(PlacedLight{glm::dvec3(world[3]), intensity, {}});
  if (!is_spot) return;
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double inner = light.spot.innerConeAngle * kDegrees,
               outer = light.spot.outerConeAngle * kDegrees;
  // 90 degrees are pi / 2 but for rounding.
  if (!(inner >= 0.0 && inner < outer && outer <= 90.0 + 1e-9)) {
    file_.fail("a spot light's angles: expected 0 <= inner < outer <= pi / 2");
  }
  placed.spot = SpotCone{direction, inner, std::min(outer, 90.0)};
}

void GltfLights::place() {
  for (const PlacedLight& light : lights_) {
    const glm::vec3 rounded(light.position - scene_.origin);
    if (!std::isfinite(rounded.x + rounded.y + rounded.z)) {
      file_.fail("a light is beyond the range of float");
    }
    scene_.lights.push_back({rounded, light.intensity, light.spot});
  }
}

}  // namespace raygate
