// Surfaces that are not to be seen, but for the shadows on them: illum 10.
#pragma once

#include "host/base/lane_math.h"
#include "host/light/lights.h"
#include "host/light/surface.h"

namespace raygate {

/// The matte colour at which `surface` looks like the background, in the light of all lights
/// from one point to all sides and of `around`, the radiance from all sides: where any of these is
/// kept away it is darker. At most 1. Light of other sources makes it brighter.
template <class T>
RAYGATE_INLINE Triple<T> catcher_colour(const Lights& lights, const glm::vec3& around,
                                        const Surface<T>& surface) {
  constexpr float kPerPi = 0.318309886183790671537767526745f;
  Triple<T> light = spread<T>(around);
  for (std::uint32_t i = 0; i < lights.points().size(); ++i) {
    const Lights::Light& light_record = lights.light(i);
    if (light_record.is_spot) continue;
    const Triple<T> way =
        (spread<T>(light_record.position) - surface.point) * spread<T>(lights.per_unit());
    const T squared = dot(way, way), slope = dot(surface.normal, way);
    // A cosine, over pi and the squared distance.
    const T share = slope * kPerPi / (squared * root(squared));
    light = light + spread<T>(light_record.emission) * choose(slope > 0.0f, share, T{});
  }
  const Triple<T> shown = spread<T>(lights.background());
  const auto ratio = [](const T& wanted, const T& there) {
    return choose(wanted < there, wanted / there, spread<T>(1.0f));
  };
  return {ratio(shown.x, light.x), ratio(shown.y, light.y), ratio(shown.z, light.z)};
}

}  // namespace raygate
