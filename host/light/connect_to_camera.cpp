// Light tracing: connects the surfaces of light paths to the camera.
#include "host/light/light_paths.h"
#include "host/light/sample_scattered_ray.h"
#include "host/light/shade.h"

namespace raygate {
namespace {

/// Adds light samples from surfaces of light paths to the camera's lens. First surfaces of paths
/// are excluded, as camera paths find them by sampling lights.
template <class T>
RAYGATE_INLINE void connect_to_camera(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const auto scatters = hits.bsdf.scatters() & (hits.path.history != 1u);
  if (!any(scatters) || hits.bsdf.has_rough_glass()) return;
  const SquarePoint<T> u = hits.random(streams::kLens);
  const auto x = unpack(u.x), y = unpack(u.y);
  const auto points = unpack(hits.surface.point);
  LightPaths::View views[kCount];
  for (int k = 0; k < kCount; ++k) views[k] = shading.light_paths->view_of(points[k], {x[k], y[k]});
  const Triple<T> lens =
      gather<T>([&](int k) RAYGATE_BODY -> const glm::vec3& { return views[k].lens; });
  const T per_area = gather<T>([&](int k) RAYGATE_BODY { return views[k].per_area; });
  IncidentLight<T> way(shading.lights, hits, lens);
  const auto seen = hits.seen_from(way.direction);
  const Triple<T>& view = hits.surface.view;
  const T pixels = per_area * edge_cosine(hits, way.direction);
  const T in = edge_cosine(hits, view);
  const T pdf = seen.bsdf.pdf(view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
  const T ratio = hits.path.light_over_camera_pdf / in * pdf * pixels;
  const T mis_weight = 1.0f / (1.0f + ratio * ratio);
  const T cosine = at_least(dot(seen.normal, view), 0.0f);
  const Triple<T> light =
      hits.path.throughput * seen.bsdf.eval(view) * (cosine / in * pixels * mis_weight);
  way.is_asked = scatters & (way.cosine > 0.0f) & (per_area > 0.0f);
  add_light_sample(hits, 0, way, bounded(light), true);
}

}  // namespace

void shade_light_path(const ShadingScene& shading, HitBlock& block, HitKind kind,
                      std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.path.pdf)>;
    connect_to_camera(shading, hits);
    hits.set_radiance(zero<T>());
    if (block.batch->depth > shading.max_depth) return;
    Triple<T> none = zero<T>();
    sample_scattered_ray<true>(shading, hits,
                               LobeProbabilities<T>(hits.bsdf, hits.path.history == 1u), none);
  });
}

}  // namespace raygate
