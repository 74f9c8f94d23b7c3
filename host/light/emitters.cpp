// Emission that the camera sees directly, in mirrors and through glass.
#include "host/light/shade.h"

namespace raygate {
namespace {

/// Spawns the rays whose histories are in the mask: reflected, refracted, and straight through
/// holes and clear surfaces, which do not change the history.
template <class T>
RAYGATE_INLINE void spawn_specular_rays(Hits<T>& hits) {
  const Bsdf<T>& bsdf = hits.bsdf;
  const Triple<T>& normal = hits.surface.normal;
  ScatteredRays<T> next(hits);
  const WordOf<T> first = hits.path.sample - hits.path.history;
  const auto send = [&](std::size_t number, const Triple<T>& share,
                        const MaskOf<T>& is_way) RAYGATE_BODY {
    next.path.sample = first + next.path.history;
    next.path.throughput = hits.path.throughput * share;
    const auto is_asked = PathLanes<T>::has(hits.path.supersampled, next.path.history);
    next.is_wanted =
        is_way & is_asked & (next.path.history > 0u) & (largest(next.path.throughput) > 0.0f);
    next.send(hits, number);
  };
  if ((hits.kind & kMirrors) != 0) {
    next.reflect_off(hits, normal);
    send(0, bsdf.mirror(), bsdf.mirror_is_traced());
  }
  if ((hits.kind & kTransmits) != 0) {
    const MaskOf<T> is_way = next.pass_through(hits, normal);
    send(1, bsdf.transmission(), is_way);
  }
}

}  // namespace

void shade_emitters(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.path.pdf)>;
    Triple<T> emitted = zero<T>();
    if ((kind & kEmits) != 0) {
      emitted =
          choose(hits.are_supersampled(), hits.path.throughput * hits.bsdf.emission(), emitted);
    }
    hits.set_radiance(emitted);
    if (block.batch->depth > shading.max_depth || hits.bsdf.has_rough_glass()) return;
    spawn_specular_rays(hits);
  });
}

}  // namespace raygate
