// Whitted's ray tracing ("An improved illumination model for shaded display", 1980), as figure 2 of
// the paper has it.
#pragma once

#include "host/light/integrator.h"

namespace raygate {

/// At each hit: what the surface emits; the light of every lamp that it scatters, with a shadow
/// ray to each point light and to one point of each area light; ambient light, which reaches
/// everything, for all light between surfaces; and rays on through mirrors and glass, to the depth
/// chosen or until they count for less than the threshold. With one sample a pixel flat area
/// lights are sampled in their middle: no noise, hard shadows.
class Whitted final : public Integrator {
 public:
  using Integrator::Integrator;

  void shade(const LightRay& ray, const Surface& surface, const RandomNumbers& random,
             WaveOutput& output) override;
  [[nodiscard]] bool shadows_through_refraction() const override { return true; }

 private:
  /// Whether a ray of this weight is worth tracing; counts those that are not.
  [[nodiscard]] bool is_worthwhile(const glm::dvec3& weight);
};

}  // namespace raygate
