// Caustics on surfaces that the camera sees in mirrors and through glass.
#pragma once

#include "host/light/sample_scattered_ray.h"

namespace raygate {

inline constexpr std::uint32_t kCausticRays = 4;  // of a hit

/// Sends rays from the surfaces of has_seen_caustics() towards mirrors and glass. Light paths end
/// at the lens, and there is no way of theirs to the lens by a mirror: these caustics are found by
/// scattered rays alone, by chance. So more rays than the path's own one look for them. They go on
/// by mirrors and glass only, and count what shines at the end of that; the path's ray does not.
template <class T>
RAYGATE_INLINE void sample_seen_caustics(const ShadingScene& shading, Hits<T>& hits) {
  const Bsdf<T>& bsdf = hits.bsdf;
  const MaskOf<T> has_caustics = has_seen_caustics<false>(shading, hits);
  if (!any(has_caustics)) return;
  const auto points = unpack(hits.surface.point);
  for (std::uint32_t i = 0; i < kCausticRays; ++i) {
    ScatteredRays<T> next(hits);
    next.path.index = hits.path.index * kCausticRays + i;
    next.path.stream = hash(hits.path.stream, streams::kCausticRay);
    next.path.way = spread<WordOf<T>>(kCausticRay);
    next.path.scattered_at = hits.surface.point;
    next.path.normal = hits.lit_normal();
    next.path.emitters = WordOf<T>{};
    next.path.ratio = T{};
    const auto random = [&](std::uint32_t purpose) RAYGATE_BODY {
      return sobol_point<T>(next.path.index, hash(hits.path.stream, purpose));
    };
    next.direction =
        bsdf.sample(random(streams::kCausticDirection),
                    (hits.kind & kCoated) != 0 ? random(streams::kCausticFacet).x : T{});
    next.flat = next.direction;
    next.has_flat = next.is_transmitted = T{} > 0.0f;
    next.path.pdf = bsdf.pdf(next.direction);
    const T cosine = hits.cosine(next.direction);
    next.path.throughput = bounded(hits.path.throughput * bsdf.eval(next.direction) *
                                   (cosine / (next.path.pdf * float{kCausticRays})));
    const auto directions = unpack(next.direction);
    const auto may_meet = gather<T>([&](int k) RAYGATE_BODY {
      return shading.light_paths->may_meet(points[k], directions[k]) ? 1.0f : 0.0f;
    });
    next.is_wanted = has_caustics & (may_meet > 0.0f) & (next.path.pdf > kMinPdf) & (cosine > 0.0f);
    next.send(hits, 1 + i);
  }
  const auto has_them = unpack(choose(has_caustics, spread<T>(1.0f), T{}));
  for (int k = 0; k < hits.count; ++k) {
    if (has_them[k] > 0.0f) hits.block.scattered_counts[hits.place[k]] = 1 + kCausticRays;
  }
}

}  // namespace raygate
