#include "host/light/path.h"

#include <algorithm>
#include <cmath>

namespace raygate {
namespace {

// What random numbers and branches are for.
constexpr std::uint32_t kGoOn = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                        kDirection = 5;
constexpr int kSureSurfaces = 3;  // before chance decides whether a ray lives on

/// A lamp's density per area, seen from `point`, per steradian; 0 where the lamp is seen edge-on.
double per_steradian(double per_area, const glm::dvec3& point, const glm::dvec3& lamp,
                     const glm::dvec3& lamp_normal) {
  const glm::dvec3 way = lamp - point;
  const double squared = glm::dot(way, way);
  const double cosine = std::abs(glm::dot(lamp_normal, way)) / std::sqrt(squared);
  return cosine > 0.0 ? per_area * squared / cosine : 0.0;
}

/// How likely each way on is, in proportion to what it brings.
struct LobeChances {
  double mirror, through, scatter, sum;

  explicit LobeChances(const Bsdf& bsdf)
      : mirror(largest(bsdf.mirror())),
        through(largest(bsdf.through())),
        scatter(largest(bsdf.diffuse() + bsdf.glossy())),
        sum(mirror + through + scatter) {}
};

}  // namespace

glm::dvec3 Path::emitted(const LightRay& ray, const Surface& surface, const Bsdf& bsdf) const {
  const AreaLight* light = lights_.area_of(surface.slot);
  if (light == nullptr || ray.density == 0.0) return bsdf.emission() + bsdf.unlit();
  const double asked = per_steradian(lights_.chance(*light) / light->area(), ray.scattered_at,
                                     surface.point, surface.flat_normal);
  return bsdf.emission() * (ray.density / (ray.density + asked)) + bsdf.unlit();
}

void Path::ask_one_light(Hit& hit, const RandomNumbers& random, WaveOutput& output) {
  if (!lights_.any_power()) return;
  const std::size_t index = lights_.choose(random(kChooseLight).x);
  const double chance = lights_.chance(index);
  if (index < lights_.points().size()) {
    light_from_point(hit, index, chance, output);
    return;
  }
  if (!hit.bsdf.scatters()) return;
  const AreaLight& light = lights_.areas()[index - lights_.points().size()];
  const LightPoint point = lights_.sample(light, random(kLightPoint));
  const double per_area = chance / light.area();
  const double asked = per_steradian(per_area, hit.surface.point, point.position, point.normal);
  if (asked == 0.0) return;
  const LobeChances chances(hit.bsdf);
  const double scattered = hit.bsdf.density(glm::normalize(point.position - hit.surface.point)) *
                           chances.scatter / chances.sum;
  light_from_area(hit, point, light.radiance * (asked / (asked + scattered) / per_area), output);
}

void Path::go_on_by_chance(Hit& hit, const RandomNumbers& random, WaveOutput& output) {
  const Bsdf& bsdf = hit.bsdf;
  const LobeChances chances(bsdf);
  if (chances.sum == 0.0) return;
  const glm::dvec2 choice = random(kChooseLobe);
  glm::dvec3 weight = hit.ray.weight;
  // Chance decides before the lobe is looked at, so that no work is lost on rays that end.
  if (hit.ray.depth >= kSureSurfaces) {
    const double survival = std::min(1.0, largest(weight) * chances.sum);
    if (choice.y >= survival) return;
    weight /= survival;
  }
  const double u = choice.x * chances.sum;
  if (u < chances.mirror) {
    weight *= bsdf.mirror() * (chances.sum / chances.mirror);
    if (bsdf.mirror_is_traced()) {
      go_on_mirrored(hit, weight, kGoOn, output);
    } else {
      output.radiance[hit.ray.sample] += weight * lights_.background();
    }
    return;
  }
  if (u < chances.mirror + chances.through) {
    go_on_through(hit, weight * bsdf.through() * (chances.sum / chances.through), kGoOn, output);
    return;
  }
  const glm::dvec3 direction = bsdf.sample(random(kDirection));
  const double density = bsdf.density(direction) * chances.scatter / chances.sum;
  LightRay next;
  next.weight = glm::dvec3(0.0);
  if (density > 0.0 && glm::dot(hit.surface.flat_normal, direction) > 0.0) {
    next.weight = weight * bsdf.scattered(direction) *
                  (std::max(0.0, glm::dot(hit.surface.normal, direction)) / density);
  }
  next.stream = mixed(hit.ray.stream, kGoOn);
  next.density = density;
  next.scattered_at = hit.surface.point;
  go_on(hit, Departure::kBefore, direction, std::nullopt, next, output);
}

void Path::shade(const LightRay& ray, const Surface& surface, const RandomNumbers& random,
                 WaveOutput& output) {
  Hit hit{ray, surface, Bsdf(surface), {}, {}};
  output.radiance[ray.sample] += ray.weight * emitted(ray, surface, hit.bsdf);
  if (ray.depth > options_.max_depth) return;
  ask_one_light(hit, random, output);
  go_on_by_chance(hit, random, output);
}

}  // namespace raygate
