// Emitters that the camera sees directly, in mirrors and through glass.
#include "host/light/shade.h"

namespace raygate {
namespace {

/// Sends rays on by the ways that are asked for: in mirrors, through glass, and through what is not
/// there or clear, where the way is the same. Without `goes_on` the depth is reached: rays go on
/// only where a mask says that nothing is there.
template <class T>
RAYGATE_INLINE void spawn_by_ways(Hits<T>& hits, bool goes_on) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const auto is_asked = [&](const WordOf<T>& way) RAYGATE_BODY {
    return PathLanes<T>::has(hits.path.emitters, way + kSpecularWays) & (way > 0u);
  };
  ScatteredRays<T> next(hits);
  const WordOf<T> look = hits.path.sample - hits.path.way;
  if (goes_on && (hits.kind & kMirrors) != 0) {
    next.path.way = hits.path.way_on(0);
    next.path.sample = look + next.path.way;
    next.path.throughput = hits.path.throughput * bsdf.mirror();
    next.direction = reflect(surface.view, surface.normal);
    next.flat = reflect(surface.view, surface.flat_normal);
    next.has_flat = T{} == 0.0f;
    next.is_transmitted = T{} > 0.0f;
    const auto shows = bsdf.mirror_is_traced() & (largest(next.path.throughput) > 0.0f);
    next.is_wanted = is_asked(next.path.way) & shows;
    next.send(hits, 0);
  }
  if ((hits.kind & kTransmits) != 0) {
    const MaskOf<T>& is_bent = bsdf.is_refracting();
    const Refraction<T> bent(surface.view, surface.normal, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    const Triple<T> through = bsdf.transmission();
    next.path.way = choose(is_bent, hits.path.way_on(1), hits.path.way);
    next.path.sample = look + next.path.way;
    next.path.throughput = hits.path.throughput * through;
    next.direction = choose(is_bent, bent.direction, -surface.view);
    next.flat = choose(is_bent, flat.direction, -surface.view);
    next.has_flat = (!is_bent) | flat.exists;
    next.is_transmitted = T{} == 0.0f;
    auto shows = ((!is_bent) | bent.exists) & (largest(next.path.throughput) > 0.0f);
    if (!goes_on) {
      const T least = minimum(minimum(through.x, through.y), through.z);
      shows = shows & (!is_bent) & !(least < 1.0f);
    }
    next.is_wanted = is_asked(next.path.way) & shows;
    next.send(hits, 1);
  }
}

}  // namespace

void shade_emitters(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.path.pdf)>;
    Triple<T> emitted = zero<T>();
    if ((kind & kEmits) != 0) {
      emitted = choose(hits.are_looked_at(), hits.path.throughput * hits.bsdf.emission(), emitted);
    }
    hits.set_radiance(emitted);
    if (hits.bsdf.has_rough_glass()) return;
    spawn_by_ways(hits, block.batch->depth <= shading.max_depth);
  });
}

}  // namespace raygate
