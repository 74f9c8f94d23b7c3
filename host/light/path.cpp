// Path tracing, by next-event estimation and BSDF sampling, combined by multiple importance
// sampling; light tracing, which connects the surfaces of light paths to the camera.
#include <optional>

#include "host/light/hits.h"
#include "host/light/light_paths.h"

namespace raygate {
namespace {

// Streams of random numbers used at a surface of a path.
constexpr std::uint32_t kNextRay = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                        kDirection = 5, kFacet = 6, kLens = 9;
// Russian roulette begins after this many surfaces, for paths below this throughput.
constexpr int kRouletteDepth = 3;
constexpr float kRouletteThroughput = 0.25f;
// Least pdf of a direction. Its inverse is within the range of float.
constexpr float kMinPdf = 1e-20f;

/// Relative probabilities of sampling the lobes: their albedos. `scatter` includes rough glass.
template <class T>
struct LobeProbabilities {
  T mirror, transmission, scatter, sum;

  RAYGATE_INLINE explicit LobeProbabilities(const Bsdf<T>& bsdf)
      : mirror(bsdf.has_rough_glass() ? T{} : largest(bsdf.mirror)),
        transmission(bsdf.has_rough_glass() ? T{} : largest(bsdf.transmission)),
        scatter(bsdf.scattered_share()),
        sum(mirror + transmission + scatter) {}
  /// Excludes diffuse and glossy reflection where `is_specular`.
  RAYGATE_INLINE LobeProbabilities(const Bsdf<T>& bsdf, const MaskOf<T>& is_specular)
      : LobeProbabilities(bsdf) {
    scatter = choose(is_specular, T{}, scatter);
    sum = mirror + transmission + scatter;
  }

  /// Returns the probability of diffuse or glossy reflection; 0 if the albedo of all lobes is 0.
  [[nodiscard]] RAYGATE_INLINE T scatter_probability() const {
    return choose(sum > 0.0f, scatter / sum, T{});
  }
};

/// Returns the magnitude of a direction's cosine to the geometric normal, at least kLeastCosine.
template <class T>
RAYGATE_INLINE T edge_cosine(const Hits<T>& hits, const Triple<T>& direction) {
  return at_least(absolute(dot(hits.surface.flat_normal, direction)), kLeastCosine);
}

/// Computes PathState::light_over_camera_pdf (see LightPaths) of the rays spawned at a hit. Light
/// paths carry flux: their throughput is a product of adjoint BSDFs and, for each edge, the cosine
/// at its end nearer the light ("Robust Monte Carlo methods", 5.3).
template <bool kFromLight, class T>
struct ReversePdf {
  T arrived;  ///< PathState::light_over_camera_pdf at the hit
  T in;       ///< cosine of the incoming edge
  MaskOf<T> is_first;

  RAYGATE_INLINE ReversePdf(const ShadingScene& shading, const Hits<T>& hits)
      : in(edge_cosine(hits, hits.surface.view)), is_first(hits.path.is_first()) {
    T ratio = hits.path.light_over_camera_pdf;
    if (!kFromLight) {
      const Triple<T> way =
          (hits.surface.point - hits.path.scattered_at) * spread<T>(shading.lights.per_unit());
      const T seen = shading.light_paths->camera_ratio(-hits.surface.view) * dot(way, way);
      ratio = choose(is_first, seen, ratio);
    }
    arrived = ratio / in;
  }

  /// Updates the path state of `next` after diffuse or glossy reflection.
  RAYGATE_INLINE void scatter(const Hits<T>& hits, const Triple<T>& throughput,
                              ScatteredRays<T>& next) const {
    const auto seen = hits.seen_from(next.direction);
    const T back =
        seen.bsdf.pdf(hits.surface.view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
    const T out = edge_cosine(hits, next.direction);
    const T known = kFromLight ? back : choose(is_first, spread<T>(1.0f), back);
    next.path.light_over_camera_pdf = bounded(arrived * known * (out / next.path.pdf));
    if (!kFromLight) return;
    const T cosine = at_least(dot(seen.normal, hits.surface.view), 0.0f);
    const Triple<T> flux =
        throughput * seen.bsdf.eval(hits.surface.view) * (cosine * out / (in * next.path.pdf));
    next.path.throughput = choose(largest(next.path.throughput) > 0.0f, bounded(flux), zero<T>());
  }

  /// Updates the path state of `next` after a mirror or refraction, where `is_specular`; `eta` is 1
  /// for mirrors. Where the normal is tilted, there is no reverse path.
  RAYGATE_INLINE void mirror(const Hits<T>& hits, const MaskOf<T>& is_specular, const T& eta,
                             ScatteredRays<T>& next) const {
    const T out = edge_cosine(hits, next.direction);
    const auto has_back = !hits.surface.is_tilted();
    const T ratio = choose(has_back & (kFromLight ? has_back : !is_first), arrived * out, T{});
    next.path.light_over_camera_pdf = choose(is_specular, ratio, next.path.light_over_camera_pdf);
    if (!kFromLight) return;
    const T facing = absolute(dot(hits.surface.normal, hits.surface.view));
    const T leaving = at_least(absolute(dot(hits.surface.normal, next.direction)), kLeastCosine);
    const T scale = out * facing / (in * leaving * eta * eta);
    next.path.throughput =
        choose(is_specular, bounded(next.path.throughput * scale), next.path.throughput);
    next.has_flat = next.has_flat & !is_specular;
    next.is_wanted = next.is_wanted & (has_back | !is_specular);
  }
};

/// Spawns one ray per hit: samples a lobe of the BSDF by its probability, then a direction.
template <bool kFromLight, class T>
RAYGATE_INLINE void sample_scattered_ray(const ShadingScene& shading, Hits<T>& hits,
                                         const LobeProbabilities<T>& lobes) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const SquarePoint<T> choice = hits.random(kChooseLobe);
  Triple<T> throughput = hits.path.throughput;
  ScatteredRays<T> next(hits);
  next.is_wanted = lobes.sum > 0.0f;
  // Russian roulette precedes the choice of a lobe, so that terminated rays cost nothing.
  if (hits.block.batch->depth >= kRouletteDepth) {
    const T weight =
        kFromLight ? spread<T>(1.0f) : largest(throughput) * (1.0f / kRouletteThroughput);
    const T survival = at_most(weight * lobes.sum, 1.0f);
    next.is_wanted = next.is_wanted & (choice.y < survival);
    throughput = choose(next.is_wanted, throughput * (1.0f / survival), throughput);
  }
  if (!any(next.is_wanted)) return;
  const T u = choice.x * lobes.sum;
  const auto is_mirrored = u < lobes.mirror;
  next.is_transmitted = (!is_mirrored) & (u < lobes.mirror + lobes.transmission);
  next.has_flat = is_mirrored | next.is_transmitted;
  next.path.stream = hash(hits.path.stream, kNextRay);

  const bool has_reverse = kFromLight || shading.light_paths != nullptr;
  std::optional<ReversePdf<kFromLight, T>> reverse;
  if (has_reverse) reverse.emplace(shading, hits);
  const bool has_rough_glass = bsdf.has_rough_glass();
  next.path.scattered_at = surface.point;
  next.path.normal = hits.lit_normal();
  const WordOf<T> none{};
  next.path.specular_history = none;
  next.path.supersampled = choose(next.has_flat, hits.path.supersampled, none);
  next.direction = next.flat = zero<T>();
  if (any(bsdf.scatters())) {
    next.direction =
        bsdf.sample(hits.random(kDirection), has_rough_glass ? hits.random(kFacet).x : T{});
    next.flat = next.direction;
    next.path.pdf = bsdf.pdf(next.direction) * lobes.scatter_probability();
    const T cosine = hits.cosine(next.direction);
    const auto contributes = (next.path.pdf > kMinPdf) & (cosine > 0.0f);
    next.path.throughput = choose(
        contributes, bounded(throughput * bsdf.eval(next.direction) * (cosine / next.path.pdf)),
        zero<T>());
    // Light paths end at rough glass: beyond it, PathState::light_over_camera_pdf is 0.
    if (has_rough_glass) {
      if (kFromLight) return;
      next.is_transmitted = dot(surface.normal, next.direction) < 0.0f;
      next.is_wanted = next.is_wanted & contributes;
      next.path.light_over_camera_pdf = T{};
      next.send(hits, 0);
      return;
    }
    if (has_reverse) reverse->scatter(hits, throughput, next);
  }
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> reflected = reflect(surface.view, surface.normal);
    const Triple<T> reflected_throughput = throughput * bsdf.mirror * (lobes.sum / lobes.mirror);
    next.direction = choose(is_mirrored, reflected, next.direction);
    next.flat = choose(is_mirrored, reflect(surface.view, surface.flat_normal), next.flat);
    next.path.throughput = choose(is_mirrored, reflected_throughput, next.path.throughput);
    next.path.pdf = choose(is_mirrored, T{}, next.path.pdf);
    next.path.specular_history =
        choose(is_mirrored, hits.path.after_mirror(), next.path.specular_history);
  }
  const auto is_bent = next.is_transmitted & bsdf.is_refracting;
  const auto is_straight = next.is_transmitted & !bsdf.is_refracting;
  if ((hits.kind & kTransmits) != 0) {
    ScatteredRays<T> beyond(hits);
    const MaskOf<T> exists = beyond.pass_through(hits, surface.normal);
    const auto use_beyond = [&](auto& own, const auto& others)
                                RAYGATE_BODY { own = choose(next.is_transmitted, others, own); };
    use_beyond(next.direction, beyond.direction);
    use_beyond(next.flat, beyond.flat);
    use_beyond(next.path.specular_history, beyond.path.specular_history);
    next.has_flat = next.has_flat & ((!next.is_transmitted) | beyond.has_flat);
    next.is_wanted = next.is_wanted & ((!next.is_transmitted) | exists);
    const Triple<T> transmitted_throughput =
        throughput * bsdf.transmission * (lobes.sum / lobes.transmission);
    use_beyond(next.path.throughput, transmitted_throughput);
    use_beyond(next.path.pdf, choose(is_straight, hits.path.pdf, T{}));
    next.path.scattered_at = choose(is_straight, hits.path.scattered_at, next.path.scattered_at);
    next.path.normal = choose(is_straight, hits.path.normal, next.path.normal);
  }
  if (has_reverse) {
    const T eta = choose(is_bent, bsdf.eta, spread<T>(1.0f));
    reverse->mirror(hits, is_mirrored | is_bent, eta, next);
    next.path.light_over_camera_pdf =
        choose(is_straight, hits.path.light_over_camera_pdf, next.path.light_over_camera_pdf);
  }
  next.send(hits, 0);
}

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

/// Returns the emission of the surfaces, times the throughput and MIS weight of the ray.
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
         (hits.emission() * (mis_weight * caustic_weights(shading, hits)) + hits.bsdf.unlit);
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
    static const Lights::Light no_light{.kind = Kind::kNone};
    const SquarePoint<T> u = hits.random(kChooseLight);
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
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> points(const Lights& all,
                                                       const Hits<T>& hits) const {
    IncidentLight<T> light = point_light(
        all, hits, lights, gather<T>(sources, &Lights::Source::light), false, kLightPoint);
    light.is_asked = are(Kind::kPoint);
    light.pdf = pmf;
    return light;
  }
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> directions(const Hits<T>& hits) const {
    IncidentLight<T> light(hits, gather<T>(lights, &Lights::Light::position));
    light.is_asked = are(Kind::kDirection);
    light.emission = gather<T>(lights, &Lights::Light::emission);
    light.pdf = pmf;
    return light;
  }
  [[nodiscard]] RAYGATE_INLINE IncidentLight<T> environment(const Environment& all,
                                                            const Hits<T>& hits) const {
    IncidentLight<T> light(hits, all.sample<T>(hits.random(kLightPoint)));
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
      // Lanes without an area light also sample a patch; the result is unused.
      patches[k] = sources[k]->patch == kNoIndex ? 0 : sources[k]->patch;
    }
    const LightPoint<T> point = all.sample_patches<T>(patches, hits.random(kLightPoint));
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
  if (any(light.is_asked & !is_delta)) {  // scattered rays may find the light, too
    const T light_pdf =
        choose(light.is_area, light.pdf * light.distance_squared / light.light_cosine, light.pdf);
    const T bsdf_pdf = hits.bsdf.pdf(light.direction) * lobes.scatter_probability();
    mis_weight =
        choose((bsdf_pdf > kMinPdf) & !is_delta, power_heuristic(light_pdf, bsdf_pdf), mis_weight);
  }
  const Triple<T> scattered = hits.bsdf.eval(light.direction, is_delta);
  add_light_sample(hits, 0, light, scattered_light(hits, light, scattered, mis_weight));
}

/// Adds light samples from surfaces of light paths to the camera's lens. First surfaces of light
/// paths are excluded, because camera paths light them by sampling lights.
template <class T>
RAYGATE_INLINE void connect_to_camera(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const auto is_first = hits.path.is_first();
  const auto scatters = hits.bsdf.scatters() & !is_first;
  if (!any(scatters) || hits.bsdf.has_rough_glass()) return;
  const SquarePoint<T> u = hits.random(kLens);
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
  shade_in_lanes(shading, block, kind, at, [&]<class T>(Hits<T>& hits) RAYGATE_BODY {
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
  shade_in_lanes(shading, block, kind, at, [&]<class T>(Hits<T>& hits) RAYGATE_BODY {
    connect_to_camera(shading, hits);
    hits.set_radiance(zero<T>());
    if (block.batch->depth > shading.max_depth) return;
    sample_scattered_ray<true>(shading, hits,
                               LobeProbabilities<T>(hits.bsdf, hits.path.is_first()));
  });
}

}  // namespace raygate
