// Camera rays alone.
#pragma once

#include "host/light/integrator.h"

namespace raygate {

/// Each surface lit from the camera: its diffuse colour times the cosine of the view, and what it
/// emits.
class Primary final : public Integrator {
 public:
  Primary(const Scene& scene, const NeighborClearances& clearances, const Lights& lights,
          const Skips& skips, const IntegratorOptions& options)
      : Integrator(scene, clearances, lights, skips, options, 0, 0) {
    shading_.sees_environment = false;
  }

  [[nodiscard]] glm::vec3 background() const override { return glm::vec3(0.0f); }

 private:
  void shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) override;
};

}  // namespace raygate
