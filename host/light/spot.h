// How much of a spot light's intensity goes in a direction.
#pragma once

#include "host/base/elementary.h"
#include "host/base/lane_math.h"
#include "host/scene/scene.h"

namespace raygate {

/// A SpotCone as shading reads it: KHR_lights_punctual's ramp of the cosine from the axis.
struct SpotFalloff {
  glm::vec3 axis{0.0f};
  float scale = 0.0f, offset = 1.0f;  ///< of a light to all sides: 1 everywhere

  SpotFalloff() = default;
  explicit SpotFalloff(const SpotCone& cone) : axis(cone.axis) {
    constexpr double kLeastRamp = 1e-6;
    const double inner = sine_cosine(cone.inner / 360.0).cosine;
    const double outer = sine_cosine(cone.outer / 360.0).cosine;
    const double slope = 1.0 / (inner - outer > kLeastRamp ? inner - outer : kLeastRamp);
    scale = static_cast<float>(slope);
    offset = static_cast<float>(-outer * slope);
  }
};

/// The share of the intensity at an angle from the axis with this cosine: 1 within the cone's inner
/// angle, 0 beyond its outer one.
template <class T>
RAYGATE_INLINE T spot_falloff(const T& cosine, const T& scale, const T& offset) {
  const T ramp = at_most(at_least(cosine * scale + offset, 0.0f), 1.0f);
  return ramp * ramp;
}

}  // namespace raygate
