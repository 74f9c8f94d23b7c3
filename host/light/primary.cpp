#include "host/light/primary.h"

#include "host/light/in_lanes.h"

namespace raygate {

void Primary::shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) {
  in_lanes(shading_, block, kind, at, [](auto& hits) RAYGATE_BODY {
    const auto facing = at_least(dot(hits.surface.normal, hits.surface.view), 0.0f);
    hits.set_radiance(hits.surface.colour * facing + hits.bsdf.emission());
  });
}

}  // namespace raygate
