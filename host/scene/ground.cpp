#include "host/scene/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/scene/bounds.h"

namespace raygate {

void add_ground(Scene& scene, const glm::dvec3& up) {
  if (is_empty(scene)) return;
  const glm::dvec3 upright =
      glm::normalize(up / std::max({std::abs(up.x), std::abs(up.y), std::abs(up.z)}));
  const auto [low, high] = position_bounds(scene);
  double lowest = std::numeric_limits<double>::infinity();
  for_each_position(scene, [&](const glm::vec3& position) {
    lowest = std::min(lowest, glm::dot(glm::dvec3(position), upright));
  });
  // A floor of the scene's own is seen, not this one.
  constexpr double kBelow = 0x1p-11, kHalfSide = 16.0;
  const double size = glm::length(high - low);
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 centre = middle + (lowest - kBelow * size - glm::dot(middle, upright)) * upright;
  const glm::dvec3 across = std::abs(upright.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 v = kHalfSide * size * glm::normalize(glm::cross(across, upright));
  const glm::dvec3 u = glm::cross(v, upright);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::dvec3& corner : {-u - v, u - v, u + v, v - u}) {
    const glm::vec3 rounded(centre + corner);
    if (!std::isfinite(rounded.x + rounded.y + rounded.z)) {
      scene.positions.resize(first);
      return;
    }
    scene.positions.push_back(rounded);
  }
  for (const std::uint32_t second : {1u, 2u}) {
    Triangle& triangle = scene.triangles.emplace_back();
    triangle.vertices = {first, first + second, first + second + 1};
    triangle.material = static_cast<std::uint32_t>(scene.materials.size());
    triangle.object = static_cast<std::uint32_t>(scene.objects.size());
  }
  Material& material = scene.materials.emplace_back();
  material.name = "ground";
  material.illumination_model = 10;
  scene.objects.emplace_back("ground");
}

}  // namespace raygate
