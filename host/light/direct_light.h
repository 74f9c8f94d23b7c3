// Direct light: what samples of lights contribute to hits where nothing is between.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "host/light/hits.h"

namespace raygate {

/// Finite numbers for products of what is too bright and what is nothing: infinity becomes the
/// largest float, NaN 0.
template <class T>
RAYGATE_INLINE T bounded(const T& x) {
  const T most = spread<T>(std::numeric_limits<float>::max());
  return choose(x < most, x, choose(x == x, most, T{}));
}
template <class T>
RAYGATE_INLINE Triple<T> bounded(const Triple<T>& x) {
  return {bounded(x.x), bounded(x.y), bounded(x.z)};
}

/// The directions from surfaces to points on lights, and the distances in the units of Lights.
template <class T>
struct DirectionToLight {
  Triple<T> direction;  ///< unit vector
  T distance_squared;
  T cosine;  ///< as Hits::cosine has it; 0 where they lead nowhere

  RAYGATE_INLINE DirectionToLight(const Lights& lights, const Hits<T>& hits,
                                  const Triple<T>& place) {
    constexpr float kNear = 1e-30f;  // floats have room for the inverse
    const Triple<T> way = (place - hits.surface.point) * spread<T>(lights.per_unit());
    distance_squared = dot(way, way);
    direction = way * (1.0f / root(distance_squared));
    cosine = choose(distance_squared > kNear, hits.cosine(direction), T{});
  }
};

/// Asks for light from a direction that is `light` where nothing is between; `number` says which of
/// its hit's samples it is.
template <class T>
RAYGATE_INLINE void add_light_sample(Hits<T>& hits, std::size_t number, const MaskOf<T>& is_asked,
                                     const Triple<T>& towards, const Triple<T>& light,
                                     const std::uint32_t (&indices)[kLanesOf<T>],
                                     const LightPoint<T>& point) {
  const auto asked = unpack(is_asked);
  const auto radiances = unpack(light), points = unpack(point.position);
  const auto primitives = unpack(point.primitive);
  const bool from_behind = hits.bsdf.has_rough_glass();
  const auto sides = unpack(from_behind ? dot(hits.surface.flat_normal, towards) : T{});
  for (int k = 0; k < hits.count; ++k) {
    if (!asked[k]) continue;
    const bool is_dark = radiances[k] == glm::vec3(0.0f);
    hits.block.light_sample(hits.place[k], number) = {
        is_dark ? LightSample::kDark : LightSample::kToTrace,
        radiances[k],
        !is_dark && sides[k] < 0.0f ? SpawnSide::kTransmitted : SpawnSide::kIncident,
        indices[k],
        points[k],
        primitives[k]};
  }
}

/// The light of point lights that surfaces scatter, per chance.
template <class T>
RAYGATE_INLINE Triple<T> point_light_contribution(const Hits<T>& hits, const Lights& lights,
                                                  const Triple<T>& position,
                                                  const Triple<T>& intensity, const T& chance) {
  const DirectionToLight<T> to_light(lights, hits, position);
  const Triple<T> light = hits.throughput * hits.bsdf.eval_for_point_light(to_light.direction) *
                          intensity * (to_light.cosine / (to_light.distance_squared * chance));
  return choose(to_light.cosine > 0.0f, bounded(light), zero<T>());
}

/// a^2 / (a^2 + b^2), where a may be infinite.
template <class T>
RAYGATE_INLINE T power_heuristic(const T& a, const T& b) {
  const T over = b / a;
  return 1.0f / (1.0f + over * over);
}

/// What is seen in a direction where nothing is; unit vectors.
template <class T>
RAYGATE_INLINE Triple<T> sky(const Lights& lights, const Triple<T>& direction) {
  const Environment* const environment = lights.environment();
  return environment != nullptr ? environment->radiance(direction) : spread<T>(lights.background());
}

/// The cosine between a spot light's axis and the way from it to the surface.
template <class T>
RAYGATE_INLINE T spot_cosine(const Hits<T>& hits, const Lights& lights, const Triple<T>& position,
                             const Triple<T>& axis) {
  return -dot(DirectionToLight<T>(lights, hits, position).direction, axis);
}

/// The light of one direction that surfaces scatter, per chance; `towards` is a unit vector, and
/// `scattered` says how much of it.
template <class T>
RAYGATE_INLINE Triple<T> directional_light_contribution(const Hits<T>& hits,
                                                        const Triple<T>& towards,
                                                        const Triple<T>& scattered,
                                                        const Triple<T>& irradiance,
                                                        const T& chance) {
  const T cosine = hits.cosine(towards);
  const Triple<T> light = hits.throughput * scattered * irradiance * (cosine / chance);
  return choose(cosine > 0.0f, bounded(light), zero<T>());
}

/// The light of points of lights; `weighted` is radiance over the pdf of the point, per area,
/// and whatever else it is to be multiplied with.
template <class T>
RAYGATE_INLINE Triple<T> area_light_contribution(const Hits<T>& hits,
                                                 const DirectionToLight<T>& to_light,
                                                 const LightPoint<T>& point,
                                                 const Triple<T>& weighted) {
  const T cosines = to_light.cosine * absolute(dot(point.normal, to_light.direction));
  const Triple<T> light = hits.throughput * hits.bsdf.eval(to_light.direction) *
                          (cosines / to_light.distance_squared) * weighted;
  return choose(to_light.cosine > 0.0f, bounded(light), zero<T>());
}

}  // namespace raygate
