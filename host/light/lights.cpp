#include "host/light/lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "host/exact/exact.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

bool emits(const Material& material) {
  return glm::any(glm::greaterThan(material.emission, glm::vec3(0.0f)));
}

double mean(const glm::dvec3& colour) { return (colour.x + colour.y + colour.z) / 3.0; }

/// In the order of the scene's triangles: lamps, and what is sampled of them, do not depend on how
/// the tree is built.
std::vector<std::uint32_t> emitting_slots(const Scene& scene, const Bvh& bvh) {
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < bvh.slot_count(); ++slot) {
    if (emits(scene.materials[scene.triangles[bvh.triangle_of(slot)].material])) {
      slots.push_back(slot);
    }
  }
  std::ranges::sort(slots, {}, [&](std::uint32_t slot) { return bvh.triangle_of(slot); });
  return slots;
}

/// All faces in one plane, with one side in common: their middle is then among them or near.
void find_middle(const Bvh& bvh, AreaLight& light) {
  const glm::dvec3 normal = glm::normalize(triangle_normal(bvh.corners_of(light.slots[0])));
  glm::dvec3 sum(0.0);
  double before = 0.0;
  bool is_flat = true;
  for (std::size_t i = 0; i < light.slots.size(); ++i) {
    const Corners& t = bvh.corners_of(light.slots[i]);
    const glm::dvec3 middle = (glm::dvec3(t[0]) + glm::dvec3(t[1]) + glm::dvec3(t[2])) / 3.0;
    sum += (light.area_up_to[i] - before) * middle;
    before = light.area_up_to[i];
    const glm::dvec3 own = glm::normalize(triangle_normal(t));
    is_flat = is_flat && std::abs(glm::dot(own, normal)) > 1.0 - 1e-9;
  }
  light.is_flat = is_flat;
  // A little towards the first face: as a rule, the very middle of a lamp of two triangles is on
  // the edge between them, and exact arithmetic would have to say which one each ray meets.
  const Corners& first = bvh.corners_of(light.slots[0]);
  const glm::dvec3 inside =
      (glm::dvec3(first[0]) + glm::dvec3(first[1]) + glm::dvec3(first[2])) / 3.0;
  light.middle = glm::mix(sum / light.area(), inside, 0x1p-10);
  light.middle_normal = normal;
}

/// The reflected part of what one side of the lamps sends out, F r / (1 - r), over pi times all
/// area; r is the mean reflectance.
glm::dvec3 guessed_ambient(const Scene& scene, const std::vector<AreaLight>& lamps) {
  glm::dvec3 flux(0.0), reflecting(0.0);
  double area = 0.0;
  for (const AreaLight& lamp : lamps) flux += std::numbers::pi * lamp.area() * lamp.radiance;
  if (flux == glm::dvec3(0.0)) return flux;
  for (const Triangle& face : scene.triangles) {
    const auto& [a, b, c] = face.vertices;
    const double own =
        0.5 *
        glm::length(triangle_normal({scene.positions[a], scene.positions[b], scene.positions[c]}));
    area += own;
    reflecting += own * glm::dvec3(scene.materials[face.material].diffuse);
  }
  const glm::dvec3 mean = glm::clamp(reflecting / area, glm::dvec3(0.0), glm::dvec3(0.9));
  return flux * mean / (1.0 - mean) / (std::numbers::pi * area);
}

}  // namespace

void light_if_dark(Scene& scene, const Camera& camera) {
  if (!scene.lights.empty() || scene.background != glm::vec3(0.0f)) return;
  if (scene.positions.empty()) return;
  for (const Triangle& triangle : scene.triangles) {
    if (emits(scene.materials[triangle.material])) return;
  }
  glm::dvec3 low(scene.positions[0]), high = low;
  for (const glm::vec3& position : scene.positions) {
    low = glm::min(low, glm::dvec3(position));
    high = glm::max(high, glm::dvec3(position));
  }
  const glm::dvec3 eye(camera.eye()), middle = 0.5 * (low + high);
  const double size = glm::length(high - low);
  const bool is_inside =
      glm::all(glm::lessThanEqual(low, eye)) && glm::all(glm::lessThanEqual(eye, high));
  const glm::dvec3 lamp =
      is_inside
          ? eye
          : middle + size * (1.2 * camera.up() - 0.8 * camera.right() - 1.3 * camera.forward());
  // In the middle of the scene a white wall that faces the lamp has radiance 0.8 from it.
  const double distance = is_inside ? 0.35 * size : glm::length(lamp - middle);
  const double intensity = 0.8 * std::numbers::pi * distance * distance;
  scene.lights.push_back({glm::vec3(lamp), glm::dvec3(intensity)});
  scene.background = glm::vec3(0.18f, 0.2f, 0.24f);
}

Lights::Lights(const Scene& scene, const Bvh& bvh) : scene_(scene), bvh_(bvh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> known;
  for (const std::uint32_t slot : emitting_slots(scene, bvh)) {
    const Triangle& face = scene.triangles[bvh.triangle_of(slot)];
    const Material& material = scene.materials[face.material];
    if (area_of_slot_.empty()) area_of_slot_.assign(bvh.slot_count(), kNoIndex);
    const auto [at, is_new] = known.try_emplace({face.object, face.material}, areas_.size());
    if (is_new) {
      areas_.emplace_back();
      areas_.back().radiance = glm::dvec3(material.emission);
    }
    area_of_slot_[slot] = static_cast<std::uint32_t>(at->second);
    AreaLight& light = areas_[at->second];
    const double area = 0.5 * glm::length(triangle_normal(bvh.corners_of(slot)));
    light.area_up_to.push_back((light.slots.empty() ? 0.0 : light.area()) + area);
    light.slots.push_back(slot);
  }
  double power = 0.0;
  for (const PointLight& light : scene.lights) {
    power += 4.0 * std::numbers::pi * mean(light.intensity);
    power_up_to_.push_back(power);
  }
  for (AreaLight& light : areas_) {
    find_middle(bvh, light);
    power += 2.0 * std::numbers::pi * light.area() * mean(light.radiance);
    power_up_to_.push_back(power);
  }
  ambient_ = background() != glm::dvec3(0.0) ? background() : guessed_ambient(scene, areas_);
}

LightPoint Lights::sample(const AreaLight& light, const glm::dvec2& u) const {
  const double wanted = u.x * light.area();
  const auto above = std::upper_bound(light.area_up_to.begin(), light.area_up_to.end() - 1, wanted);
  const auto index = static_cast<std::size_t>(above - light.area_up_to.begin());
  const double before = index == 0 ? 0.0 : light.area_up_to[index - 1];
  const double rest = std::clamp((wanted - before) / (*above - before), 0.0, 1.0);
  // The square onto the triangle: sqrt keeps areas.
  const double root = std::sqrt(rest);
  const Corners& t = bvh_.corners_of(light.slots[index]);
  const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
  return {(1.0 - root) * a + root * ((1.0 - u.y) * b + u.y * c), glm::normalize(triangle_normal(t)),
          light.slots[index]};
}

LightPoint Lights::middle(const AreaLight& light) {
  return {light.middle, light.middle_normal, light.slots[0]};
}

const AreaLight* Lights::area_of(std::uint32_t slot) const {
  if (area_of_slot_.empty() || area_of_slot_[slot] == kNoIndex) return nullptr;
  return &areas_[area_of_slot_[slot]];
}

std::size_t Lights::choose(double u) const {
  const auto above =
      std::upper_bound(power_up_to_.begin(), power_up_to_.end() - 1, u * power_up_to_.back());
  return static_cast<std::size_t>(above - power_up_to_.begin());
}

double Lights::chance(std::size_t light) const {
  const double before = light == 0 ? 0.0 : power_up_to_[light - 1];
  return (power_up_to_[light] - before) / power_up_to_.back();
}

}  // namespace raygate
