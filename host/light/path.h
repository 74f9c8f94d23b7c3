// Path tracing (Kajiya, "The rendering equation", 1986).
#pragma once

#include "host/light/integrator.h"

namespace raygate {

/// At each hit one light is asked for its light, and one ray goes on, scattered, mirrored or
/// through the surface. Where a scattered ray finds a light itself, both ways of finding it are
/// weighed by how likely each was, squared (the power heuristic of Veach and Guibas, 1995). After
/// three surfaces a ray that counts for less than a quarter lives on by chance, and counts for a
/// quarter then. The last rays, one deeper than the depth chosen, see what emits and nothing else.
class Path final : public Integrator {
 public:
  Path(const Scene& scene, const NeighborClearances& clearances, const Lights& lights,
       const Skips& skips, const IntegratorOptions& options)
      : Integrator(scene, clearances, lights, skips, options, 1, 1) {
    // What rays that leave the scene bring.
    shading_.ambient = lights.background();
    shading_.samples_environment = true;
  }

  [[nodiscard]] bool shadows_through_refraction() const override { return false; }

 private:
  void shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) override;
};

}  // namespace raygate
