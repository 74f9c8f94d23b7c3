#include "host/light/integrator.h"

#include <algorithm>
#include <cmath>

#include "host/light/fresnel.h"
#include "host/light/path.h"
#include "host/light/whitted.h"

namespace raygate {

const std::optional<glm::vec3>& Integrator::departure(Hit& hit, Departure way) {
  auto& point = way == Departure::kBefore ? hit.before : hit.after;
  if (!point) point = departure_.find(hit.ray.ray, hit.surface.slot, way);
  return *point;
}

void Integrator::ask(Hit& hit, ShadowRay shadow, WaveOutput& output) {
  if (shadow.light == glm::dvec3(0.0) && skips_.light_behind) {
    ++skipped_.lights_behind;
    return;
  }
  const auto& origin = departure(hit, Departure::kBefore);
  if (!origin) return;
  shadow.sample = hit.ray.sample;
  shadow.surface = *origin;
  shadow.surface_slot = hit.surface.slot;
  output.shadows.push_back(shadow);
}

void Integrator::light_from_point(Hit& hit, std::size_t light, double chance, WaveOutput& output) {
  const PointLight& lamp = lights_.points()[light];
  const glm::dvec3 way = glm::dvec3(lamp.position) - hit.surface.point;
  const double squared = glm::dot(way, way);
  ShadowRay shadow;
  shadow.point_light = static_cast<std::uint32_t>(light);
  if (squared > 0.0) {
    const glm::dvec3 direction = way / std::sqrt(squared);
    if (glm::dot(hit.surface.flat_normal, direction) > 0.0) {
      shadow.light = hit.ray.weight * hit.bsdf.scattered_from_point(direction) * lamp.intensity *
                     (std::max(0.0, glm::dot(hit.surface.normal, direction)) / (squared * chance));
    }
  }
  ask(hit, shadow, output);
}

void Integrator::light_from_area(Hit& hit, const LightPoint& point, const glm::dvec3& weighted,
                                 WaveOutput& output) {
  const glm::dvec3 way = point.position - hit.surface.point;
  const double squared = glm::dot(way, way);
  ShadowRay shadow;
  shadow.lamp = glm::vec3(point.position);
  shadow.lamp_slot = point.slot;
  if (squared > 0.0) {
    const glm::dvec3 direction = way / std::sqrt(squared);
    if (glm::dot(hit.surface.flat_normal, direction) > 0.0) {
      const double cosines = std::max(0.0, glm::dot(hit.surface.normal, direction)) *
                             std::abs(glm::dot(point.normal, direction));
      shadow.light =
          hit.ray.weight * hit.bsdf.scattered(direction) * weighted * (cosines / squared);
    }
  }
  ask(hit, shadow, output);
}

void Integrator::go_on(Hit& hit, Departure way, const glm::dvec3& direction,
                       const std::optional<glm::dvec3>& flat, LightRay next, WaveOutput& output) {
  if (next.weight == glm::dvec3(0.0) && skips_.weightless) {
    ++skipped_.weightless;
    return;
  }
  const Ray& ray = hit.ray.ray;
  const auto leaves = [&](const glm::vec3& scaled) {
    return departure_.leaves(ray, hit.surface.slot, way, scaled);
  };
  next.ray.direction = scaled_direction(direction);
  if (!leaves(next.ray.direction)) {
    if (!flat) return;
    next.ray.direction = scaled_direction(*flat);
    if (!leaves(next.ray.direction)) return;
  }
  const auto& origin = departure(hit, way);
  if (!origin) return;
  next.ray.origin = *origin;
  next.sample = hit.ray.sample;
  next.depth = hit.ray.depth + 1;
  output.next.push_back(next);
}

void Integrator::go_on_mirrored(Hit& hit, const glm::dvec3& weight, std::uint32_t branch,
                                WaveOutput& output) {
  LightRay next;
  next.weight = weight;
  next.stream = mixed(hit.ray.stream, branch);
  go_on(hit, Departure::kBefore, hit.bsdf.mirror_direction(),
        reflected(-hit.surface.view, hit.surface.flat_normal), next, output);
}

void Integrator::go_on_through(Hit& hit, const glm::dvec3& weight, std::uint32_t branch,
                               WaveOutput& output) {
  const auto direction = hit.bsdf.through_direction(hit.surface.normal);
  if (!direction) return;
  LightRay next;
  next.weight = weight;
  next.stream = mixed(hit.ray.stream, branch);
  if (!hit.bsdf.is_refracting()) {
    next.density = hit.ray.density;  // as if there were nothing
    next.scattered_at = hit.ray.scattered_at;
  }
  go_on(hit, Departure::kAfter, *direction, hit.bsdf.through_direction(hit.surface.flat_normal),
        next, output);
}

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, const Clearances& clearances,
                                            const Lights& lights, const Skips& skips,
                                            const IntegratorOptions& options) {
  if (kind == IntegratorKind::kPath) {
    return std::make_unique<Path>(clearances, lights, skips, options);
  }
  return std::make_unique<Whitted>(clearances, lights, skips, options);
}

}  // namespace raygate
