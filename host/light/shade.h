// The shading functions of the integrators, for hits of one kind, and the unoccluded contribution
// of light samples to hits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "host/base/vectors.h"
#include "host/light/hits.h"

namespace raygate {

/// Calls shade(hits) for the hits at positions `at` of the block, as many at a time as there are
/// lanes. The baseline has one lane and is the reference for the others, which give the same bits.
template <class Shade>
void shade_in_lanes(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at, const Shade& shade) {
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = kLanesOf<T>;
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      Hits<T> hits(shading, block, kind, at.subspan(i, std::min(kCount, at.size() - i)));
      shade(hits);
    }
  });
}

/// Shades the hits at positions `at` of the block, all of one kind.
using ShadeFunction = void(const ShadingScene& shading, HitBlock& block, HitKind kind,
                           std::span<const std::uint32_t> at);

/// Whitted's ray tracing ("An improved illumination model for shaded display", 1980), as in figure
/// 2 of the paper. At each hit: emission; direct light of every light, with a shadow ray to each
/// point light and to one point of each area light; an ambient term for interreflection; and rays
/// through mirrors and glass, up to the maximum depth or until their throughput is below the
/// threshold. With one sample per pixel a light that is one triangle or parallelogram is sampled at
/// its centre: no noise, hard shadows.
ShadeFunction shade_whitted;

/// Path tracing (Kajiya, "The rendering equation", 1986). At each hit one light is sampled and one
/// ray is spawned: scattered, reflected or transmitted. Light that both can find is weighted by
/// multiple importance sampling (the power heuristic of Veach and Guibas, 1995). Russian roulette
/// begins after three surfaces. The last rays, one deeper than the maximum depth, add emission
/// only.
ShadeFunction shade_path;

/// Light tracing (Dutre, Lafortune and Willems, "Monte Carlo light tracing with direct computation
/// of pixel intensities", 1993): each hit after a first mirror or glass is connected to the camera
/// by a light sample whose target is on the lens, and one ray is spawned.
ShadeFunction shade_light_path;

/// Shades hits on specular paths from the camera whose histories are in PathState::supersampled:
/// adds emission, and spawns reflected and refracted rays. A ray's sample is a multiple of
/// kSpecularHistories plus its history, so that radiance is separated by history.
ShadeFunction shade_emitters;

/// Returns a finite number: infinity becomes the largest float, NaN becomes 0.
template <class T>
RAYGATE_INLINE T bounded(const T& x) {
  const T most = spread<T>(std::numeric_limits<float>::max());
  return choose(x < most, x, choose(x == x, most, T{}));
}
template <class T>
RAYGATE_INLINE Triple<T> bounded(const Triple<T>& x) {
  return {bounded(x.x), bounded(x.y), bounded(x.z)};
}

/// Unoccluded light that arrives at each hit from a point or a direction.
template <class T>
struct IncidentLight {
  MaskOf<T> is_asked = T{} > 0.0f;       ///< whether the hit samples this light
  MaskOf<T> is_area = is_asked;          ///< from an area light
  MaskOf<T> is_point_light = is_asked;   ///< from a point light
  Triple<T> direction = zero<T>();       ///< unit vector towards the light
  T distance_squared = spread<T>(1.0f);  ///< in units of Lights; 1: a distant light
  T cosine = T{};                        ///< Hits::cosine of the direction; 0: no light arrives
  T light_cosine = T{};                  ///< of an area light
  Triple<T> emission = zero<T>();        ///< radiance, intensity or irradiance
  /// Probability of the light times the density of its point (per area) or direction.
  T pdf = spread<T>(1.0f);
  Triple<T> target = zero<T>();  ///< target and index as in LightSample
  WordOf<T> index = WordOf<T>{} + NearestHit::kNone;

  IncidentLight() = default;
  /// Sets the geometry of light from a point.
  RAYGATE_INLINE IncidentLight(const Lights& lights, const Hits<T>& hits, const Triple<T>& position)
      : target(position) {
    constexpr float kNear = 1e-30f;  // the inverse is within the range of float
    const Triple<T> way = (position - hits.surface.point) * spread<T>(lights.per_unit());
    distance_squared = dot(way, way);
    direction = way * (1.0f / root(distance_squared));
    cosine = choose(distance_squared > kNear, hits.cosine(direction), T{});
  }
  /// Sets the geometry of a distant light in the direction of a unit vector.
  RAYGATE_INLINE IncidentLight(const Hits<T>& hits, const Triple<T>& towards)
      : direction(towards), cosine(hits.cosine(towards)), target(towards) {}

  /// Copies the lanes of `other` in which `is_asked` is set.
  RAYGATE_INLINE void take(const IncidentLight& other) {
    const auto put = [&](auto& own, const auto& others)
                         RAYGATE_BODY { own = choose(other.is_asked, others, own); };
    put(is_area, other.is_area);
    put(is_point_light, other.is_point_light);
    put(direction, other.direction);
    put(distance_squared, other.distance_squared);
    put(cosine, other.cosine);
    put(light_cosine, other.light_cosine);
    put(emission, other.emission);
    put(pdf, other.pdf);
    put(target, other.target);
    put(index, other.index);
    is_asked = is_asked | other.is_asked;
  }
};

/// Returns the light from point lights, one per lane, of which it leaves at `position`.
template <class T>
RAYGATE_INLINE IncidentLight<T> point_light(const Lights& lights, const Hits<T>& hits,
                                            const Lights::Light* const (&own)[kLanesOf<T>],
                                            const Triple<T>& position) {
  using Light = Lights::Light;
  IncidentLight<T> light(lights, hits, position);
  light.emission = gather<T>(own, &Light::emission);
  if (any(gather<T>(own, &Light::is_spot))) {
    const IncidentLight<T> middle(lights, hits, gather<T>(own, &Light::position));
    const T cosine = -dot(middle.direction, gather<T>(own, &Light::spot_axis));
    light.emission = light.emission * spot_falloff(cosine, gather<T>(own, &Light::spot_scale),
                                                   gather<T>(own, &Light::spot_offset));
  }
  light.target = position - hits.surface.point;
  return light;
}

/// Returns the light from points of area lights that were sampled uniformly in area.
template <class T>
RAYGATE_INLINE IncidentLight<T> area_light(const Lights& lights, const Hits<T>& hits,
                                           const LightPoint<T>& point, const Triple<T>& radiance) {
  IncidentLight<T> light(lights, hits, point.position);
  light.is_area = T{} == 0.0f;
  light.light_cosine = absolute(dot(point.normal, light.direction));
  light.emission = radiance;
  light.index = point.primitive;
  return light;
}

/// Returns the radiance that hits scatter back along their rays; `scattered` is the BSDF.
template <class T>
RAYGATE_INLINE Triple<T> scattered_light(const Hits<T>& hits, const IncidentLight<T>& light,
                                         const Triple<T>& scattered, const T& mis_weight) {
  const Triple<T>& throughput = hits.path.throughput;
  Triple<T> sent = throughput * (scattered * mis_weight) * light.emission *
                   (light.cosine / (light.distance_squared * light.pdf));
  if (any(light.is_area)) {
    const T cosines = light.cosine * light.light_cosine;
    sent = choose(light.is_area,
                  throughput * scattered * (cosines / light.distance_squared) *
                      (light.emission * (mis_weight / light.pdf)),
                  sent);
  }
  return choose(light.cosine > 0.0f, bounded(sent), zero<T>());
}

/// Stores a light sample of each hit that contributes `sent` if it is not occluded, as sample
/// `number` of the hit.
template <class T>
RAYGATE_INLINE void add_light_sample(Hits<T>& hits, std::size_t number,
                                     const IncidentLight<T>& light, const Triple<T>& sent,
                                     bool is_to_camera = false) {
  static_assert(sizeof(LightSample) == 32);
  const auto none = T{} > 0.0f;
  const auto is_dark = (sent.x == 0.0f) & (sent.y == 0.0f) & (sent.z == 0.0f);
  const auto is_behind = hits.bsdf.has_rough_glass()
                             ? MaskOf<T>(dot(hits.surface.flat_normal, light.direction) < 0.0f)
                             : none;
  const T index = float_of(light.index);
  const T flags = flag_words<T>(light.is_asked, is_dark, is_behind & !is_dark, light.is_point_light,
                                is_to_camera ? !none : none);
  const Triple<T>& target = light.target;
  const T words[] = {sent.x, sent.y, sent.z, target.x, target.y, target.z, index, flags};
  LightSample* samples[Hits<T>::kCount];
  for (int k = 0; k < hits.count; ++k)
    samples[k] = &hits.block.light_samples_of(hits.place[k])[number];
  store_records(words, samples, hits.count);
}

/// Returns a^2 / (a^2 + b^2); a may be infinite.
template <class T>
RAYGATE_INLINE T power_heuristic(const T& a, const T& b) {
  const T over = b / a;
  return 1.0f / (1.0f + over * over);
}

}  // namespace raygate
