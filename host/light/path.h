// Path tracing (Kajiya, "The rendering equation", 1986).
#pragma once

#include "host/light/integrator.h"

namespace raygate {

/// At each hit one lamp is asked for its light, and one ray goes on, scattered, mirrored or through
/// the surface. Where a scattered ray finds a lamp itself, both ways of finding it are weighed by
/// how likely each was (the balance heuristic of Veach and Guibas, 1995). After three surfaces a
/// ray that counts for little lives on by chance, and counts for more then. The last rays, one
/// deeper than the depth chosen, see what emits and nothing else.
class Path final : public Integrator {
 public:
  using Integrator::Integrator;

  void shade(const LightRay& ray, const Surface& surface, const RandomNumbers& random,
             WaveOutput& output) override;
  [[nodiscard]] bool shadows_through_refraction() const override { return false; }

 private:
  [[nodiscard]] glm::dvec3 emitted(const LightRay& ray, const Surface& surface,
                                   const Bsdf& bsdf) const;
  void ask_one_light(Hit& hit, const RandomNumbers& random, WaveOutput& output);
  void go_on_by_chance(Hit& hit, const RandomNumbers& random, WaveOutput& output);
};

}  // namespace raygate
