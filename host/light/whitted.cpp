#include "host/light/whitted.h"

namespace raygate {
namespace {

// What random numbers and branches are for.
constexpr std::uint32_t kMirror = 1, kThrough = 2, kFirstAreaLight = 16;

}  // namespace

bool Whitted::is_worthwhile(const glm::dvec3& weight) {
  const double size = largest(weight);
  if (size == 0.0 && skips_.weightless) ++skipped_.weightless;
  if (size == 0.0) return !skips_.weightless;
  if (size < options_.threshold) ++skipped_.dim;
  return size >= options_.threshold;
}

void Whitted::shade(const LightRay& ray, const Surface& surface, const RandomNumbers& random,
                    WaveOutput& output) {
  Hit hit{ray, surface, Bsdf(surface), {}, {}};
  const Bsdf& bsdf = hit.bsdf;
  glm::dvec3& radiance = output.radiance[ray.sample];
  radiance += ray.weight * (bsdf.emission() + bsdf.unlit());
  radiance += ray.weight * (bsdf.diffuse() + bsdf.glossy()) * options_.ambient;

  for (std::size_t i = 0; i < lights_.points().size(); ++i) light_from_point(hit, i, 1.0, output);
  if (bsdf.scatters()) {
    for (std::size_t i = 0; i < lights_.areas().size(); ++i) {
      const AreaLight& light = lights_.areas()[i];
      const LightPoint point =
          options_.single_sample && light.is_flat
              ? Lights::middle(light)
              : lights_.sample(light, random(kFirstAreaLight + static_cast<std::uint32_t>(i)));
      light_from_area(hit, point, light.radiance * light.area(), output);
    }
  }

  const glm::dvec3 mirrored = ray.weight * bsdf.mirror(), through = ray.weight * bsdf.through();
  if (!bsdf.mirror_is_traced()) radiance += mirrored * lights_.background();
  if (ray.depth >= options_.max_depth) return;
  if (bsdf.mirror_is_traced() && is_worthwhile(mirrored)) {
    go_on_mirrored(hit, mirrored, kMirror, output);
  }
  if (is_worthwhile(through)) go_on_through(hit, through, kThrough, output);
}

}  // namespace raygate
