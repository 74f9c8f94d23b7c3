// Whitted's ray tracing ("An improved illumination model for shaded display", 1980), as figure 2 of
// the paper has it.
#pragma once

#include "host/light/integrator.h"

namespace raygate {

/// At each hit: what the surface emits; the light of every light that it scatters, with a shadow
/// ray to each point light and to one point of each area light; ambient light, which reaches
/// everything, for all light between surfaces; and rays on through mirrors and glass, to the depth
/// chosen or until they count for less than the threshold. With one sample a pixel flat area
/// lights are sampled in their middle: no noise, hard shadows.
class Whitted final : public Integrator {
 public:
  Whitted(const Scene& scene, const NeighborClearances& clearances, const Lights& lights,
          const Skips& skips, const IntegratorOptions& options)
      : Integrator(scene, clearances, lights, skips, options, lights.count(), 2) {}

 private:
  void shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) override;
};

}  // namespace raygate
