// Path tracing, by next-event estimation and BSDF sampling, combined by multiple importance
// sampling; light tracing, which connects the surfaces of light paths to the camera.
#include "host/light/light_paths.h"
#include "host/light/sample_scattered_ray.h"
#include "host/light/shade.h"

namespace raygate {
namespace {

/// Returns the MIS weights, relative to light paths, of emission met after mirrors and glass.
template <class T>
RAYGATE_INLINE T caustic_weights(const ShadingScene& shading, const Hits<T>& hits) {
  if (shading.light_paths == nullptr) return spread<T>(1.0f);
  const auto points = unpack(hits.surface.point), views = unpack(hits.surface.view);
  const auto cosines = unpack(edge_cosine(hits, hits.surface.view));
  return gather<T>([&](int k) RAYGATE_BODY {
    return caustic_weight(hits.block.state(hits.place[k]), [&] {
      const std::uint32_t source =
          shading.lights.source_of(hits.block.places[hits.place[k]].primitive);
      if (source == kNoIndex) return 0.0f;
      return shading.light_paths->density(source, points[k], views[k]) / cosines[k];
    });
  });
}

/// Returns the emission of the surfaces, times the MIS weight of the ray that found it.
template <class T>
RAYGATE_INLINE Triple<T> emitted_radiance(const ShadingScene& shading, const Hits<T>& hits) {
  const Lights& lights = shading.lights;
  float area_pdfs[Hits<T>::kCount] = {};
  for (int k = 0; k < Hits<T>::kCount; ++k) {
    const std::uint32_t source = lights.source_of(hits.block.places[hits.place[k]].primitive);
    const PathState& state = hits.block.state(hits.place[k]);
    if (source == kNoIndex || !(state.pdf > 0.0f)) continue;
    area_pdfs[k] =
        lights.pmf<T>(source, state.scattered_at, state.normal) * lights.source(source).per_area;
  }
  const T area_pdf = load<T>(area_pdfs);
  const Triple<T> way =
      (hits.surface.point - hits.path.scattered_at) * spread<T>(lights.per_unit());
  const T squared = dot(way, way);
  const T cosine = absolute(dot(hits.surface.flat_normal, way)) / root(squared);
  const T light_pdf = choose(cosine > 0.0f, area_pdf * squared / cosine, T{});
  const T mis_weight = choose((area_pdf > 0.0f) & (hits.path.pdf > 0.0f),
                              power_heuristic(hits.path.pdf, light_pdf), spread<T>(1.0f));
  return hits.path.throughput *
         (hits.emission() * (mis_weight * caustic_weights(shading, hits)) + hits.bsdf.unlit());
}

/// One sampled light per hit.
template <class T>
struct ChosenLights {
  static constexpr int kCount = kLanesOf<T>;
  using Kind = Lights::Kind;

  const Lights::Source* sources[kCount];
  const Lights::Light* lights[kCount];
  T pmf;
  WordOf<T> kinds;

  RAYGATE_INLINE ChosenLights(const Lights& all, const Hits<T>& hits) {
    static const Lights::Source no_source{.per_area = 1.0f};
    static const Lights::Light no_light{.kind = Kind::kNone, .spot = {}};
    const SquarePoint<T> u = hits.random(streams::kChooseLight);
    const auto high = unpack(u.x), low = unpack(u.y);
    const auto points = unpack(hits.surface.point), normals = unpack(hits.lit_normal());
    LightTree::Sample samples[kCount];
    for (int k = 0; k < kCount; ++k) {
      // Two words of 24 bits resolve probabilities far below 2^-24.
      samples[k] =
          all.sample_source<T>(points[k], normals[k], double{high[k]} + double{low[k]} * 0x1p-24);
      const bool is_any = samples[k].source != kNoIndex;
      sources[k] = is_any ? &all.source(samples[k].source) : &no_source;
      lights[k] = is_any ? &all.light(sources[k]->light) : &no_light;
    }
    pmf = gather<T>(
        [&](int k) RAYGATE_BODY { return samples[k].source != kNoIndex ? samples[k].pmf : 1.0f; });
    kinds =
        gather<T>([&](int k) RAYGATE_BODY { return static_cast<std::uint32_t>(lights[k]->kind); });
  }
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> are(Kind kind) const {
    return kinds == static_cast<std::uint32_t>(kind);
  }
  template <class Member>
  [[nodiscard]] RAYGATE_INLINE auto get(Member Lights::Light::*member) const {
    return gather<T>(lights, member);
  }

  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> points(const Lights& all,
                                                       const Hits<T>& hits) const {
    const Triple<T> middle = get(&Lights::Light::position);
    const T radius = get(&Lights::Light::radius);
    const bool any_ball = any(radius > 0.0f);
    const Triple<T> position = any_ball ? Lights::point_on<T>(middle, radius, hits.surface.point,
                                                              hits.random(streams::kLightPoint))
                                        : middle;
    IncidentLight<T> light(all, hits, position);
    light.emission = get(&Lights::Light::emission);
    if (any(get(&Lights::Light::is_spot))) {
      const auto cone = [&](auto SpotFalloff::*member) RAYGATE_BODY {
        return gather<T>([&](int k) RAYGATE_BODY { return lights[k]->spot.*member; });
      };
      light.emission =
          light.emission * spot_falloff_at(hits, all, middle, cone(&SpotFalloff::axis),
                                           cone(&SpotFalloff::scale), cone(&SpotFalloff::offset));
    }
    light.is_asked = are(Kind::kPoint);
    light.pdf = pmf;
    light.target = position - hits.surface.point;
    light.is_point_light = !(radius > 0.0f);
    light.index =
        choose(light.is_point_light, gather<T>(sources, &Lights::Source::light), light.index);
    return light;
  }
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> directions(const Hits<T>& hits) const {
    IncidentLight<T> light(hits, get(&Lights::Light::position));
    light.is_asked = are(Kind::kDirection);
    light.emission = get(&Lights::Light::emission);
    light.pdf = pmf;
    return light;
  }
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> environment(const Environment& all,
                                                            const Hits<T>& hits) const {
    IncidentLight<T> light(hits, all.sample<T>(hits.random(streams::kLightPoint)));
    light.emission = all.radiance(light.direction);
    light.pdf = all.pdf(light.direction) * pmf;
    const MaskOf<T> is_chosen = are(Kind::kEnvironment), scatters = hits.bsdf.scatters();
    light.is_asked = (light.pdf > kMinPdf) & is_chosen & scatters;
    return light;
  }
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> areas(const Lights& all,
                                                      const Hits<T>& hits) const {
    std::uint32_t patches[kCount];
    for (int k = 0; k < kCount; ++k) {
      // Lanes without an area light also sample one; the result is unused.
      patches[k] = sources[k]->patch == kNoIndex ? 0 : sources[k]->patch;
    }
    const LightPoint<T> point = all.sample_patches<T>(patches, hits.random(streams::kLightPoint));
    IncidentLight<T> light = area_light(all, hits, point, all.radiance_at<T>(lights, point));
    const MaskOf<T> is_chosen = are(Kind::kArea), scatters = hits.bsdf.scatters();
    light.is_asked = (light.light_cosine > 0.0f) & is_chosen & scatters;
    light.pdf = pmf * gather<T>(sources, &Lights::Source::per_area);
    return light;
  }
};

/// Chooses one light for each hit, and samples it (next-event estimation).
template <class T>
RAYGATE_INLINE void sample_one_light(const ShadingScene& shading, Hits<T>& hits,
                                     const LobeProbabilities<T>& lobes) {
  using Kind = Lights::Kind;
  const Lights& lights = shading.lights;
  const MaskOf<T> is_lit = hits.bsdf.samples_lights();
  if (!lights.any_power() || !any(is_lit)) return;
  const ChosenLights<T> chosen(lights, hits);
  IncidentLight<T> light;
  if (any(chosen.are(Kind::kPoint))) light.take(chosen.points(lights, hits));
  if (any(chosen.are(Kind::kDirection))) light.take(chosen.directions(hits));
  const MaskOf<T> is_delta = light.is_asked;
  if (any(chosen.are(Kind::kEnvironment))) {
    light.take(chosen.environment(*lights.environment(), hits));
  }
  if (any(chosen.are(Kind::kArea))) light.take(chosen.areas(lights, hits));
  light.is_asked = light.is_asked & is_lit;

  T mis_weight = spread<T>(1.0f);
  if (any(light.is_asked & !is_delta)) {  // scattered rays may find it, too
    const T light_pdf =
        choose(light.is_area, light.pdf * light.distance_squared / light.light_cosine, light.pdf);
    const T bsdf_pdf = hits.bsdf.pdf(light.direction) * lobes.scatter_probability();
    mis_weight =
        choose((bsdf_pdf > kMinPdf) & !is_delta, power_heuristic(light_pdf, bsdf_pdf), mis_weight);
  }
  const Triple<T> scattered = hits.bsdf.eval(light.direction, is_delta);
  add_light_sample(hits, 0, light, scattered_light(hits, light, scattered, mis_weight));
}

/// Adds light samples from surfaces of light paths to the camera's lens. First surfaces of paths
/// are excluded, as camera paths find them by sampling lights.
template <class T>
RAYGATE_INLINE void connect_to_camera(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const auto is_first = hits.path.is_first();
  const auto scatters = hits.bsdf.scatters() & !is_first;
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

void shade_path(const ShadingScene& shading, HitBlock& block, HitKind kind,
                std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.path.pdf)>;
    Triple<T> radiance = zero<T>();
    if ((kind & kEmits) != 0) radiance = emitted_radiance(shading, hits);
    if (block.batch->depth <= shading.max_depth) {
      const LobeProbabilities<T> lobes(hits.bsdf);
      sample_one_light(shading, hits, lobes);
      sample_scattered_ray<false>(shading, hits, lobes);
    }
    hits.set_radiance(radiance);
  });
}

void shade_light_path(const ShadingScene& shading, HitBlock& block, HitKind kind,
                      std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.path.pdf)>;
    connect_to_camera(shading, hits);
    hits.set_radiance(zero<T>());
    if (block.batch->depth > shading.max_depth) return;
    sample_scattered_ray<true>(shading, hits,
                               LobeProbabilities<T>(hits.bsdf, hits.path.is_first()));
  });
}

}  // namespace raygate
