#include "host/light/primary.h"

#include <type_traits>

#include "host/light/in_lanes.h"

namespace raygate {

void Primary::shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) {
  shade_in_lanes(shading_, block, kind, at, [](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.pdf)>;
    const T facing = at_least(dot(hits.surface.normal, hits.surface.view), 0.0f);
    const bool is_seen = (hits.kind & kShadowCatcher) == 0;
    const Triple<T> colour = is_seen ? hits.surface.colour : zero<T>();
    hits.set_radiance(colour * facing + hits.bsdf.emission());
  });
}

}  // namespace raygate
