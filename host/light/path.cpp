// Path tracing: next-event estimation and BSDF sampling, combined by multiple importance sampling.
#include "host/light/light_paths.h"
#include "host/light/shade.h"

namespace raygate {
namespace {

// Streams of random numbers.
constexpr std::uint32_t kNextRay = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                        kDirection = 5, kFacet = 6, kLens = 9;
constexpr int kRouletteDepth = 3;  // surfaces before Russian roulette begins
constexpr float kMinPdf = 1e-20f;  // of a direction: floats have room for the inverse

/// How likely each lobe is to be sampled, in proportion to what it reflects; rough glass scatters.
template <class T>
struct LobeProbabilities {
  T mirror, transmission, scatter, sum;

  RAYGATE_INLINE explicit LobeProbabilities(const Bsdf<T>& bsdf)
      : mirror(bsdf.has_rough_glass() ? T{} : largest(bsdf.mirror())),
        transmission(bsdf.has_rough_glass() ? T{} : largest(bsdf.transmission())),
        scatter(bsdf.scattered_share()),
        sum(mirror + transmission + scatter) {}
  /// Without diffuse and glossy reflection where `is_specular`.
  RAYGATE_INLINE LobeProbabilities(const Bsdf<T>& bsdf, const MaskOf<T>& is_specular)
      : LobeProbabilities(bsdf) {
    scatter = choose(is_specular, T{}, scatter);
    sum = mirror + transmission + scatter;
  }

  /// Of diffuse and glossy reflection together; 0 where nothing is reflected at all.
  [[nodiscard]] RAYGATE_INLINE T scatter_probability() const {
    return choose(sum > 0.0f, scatter / sum, T{});
  }
};

/// The least MIS weight of a scattered ray that finds the light. Beside the light such a ray meets
/// the sky: with this weight the light is as bright to it, and chance does not matter.
float min_mis_weight(const ShadingScene& shading, const Lights::Source& source) {
  return shading.path.limits_mis_weight ? shading.lights.light(source.light).sky : 0.0f;
}

/// The cosine of a direction with the surface, as ratios of densities have it.
template <class T>
RAYGATE_INLINE T edge_cosine(const Hits<T>& hits, const Triple<T>& direction) {
  return at_least(absolute(dot(hits.surface.flat_normal, direction)), kLeastCosine);
}

/// The weights of light that paths meet after mirrors and glass, beside that of light paths.
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

/// What the surfaces emit, with the MIS weight of the ray that found it.
template <class T>
RAYGATE_INLINE Triple<T> emitted_radiance(const ShadingScene& shading, const Hits<T>& hits) {
  const Lights& lights = shading.lights;
  float area_pdfs[Hits<T>::kCount] = {}, min_weights[Hits<T>::kCount] = {};
  for (int k = 0; k < Hits<T>::kCount; ++k) {
    const std::uint32_t source = lights.source_of(hits.block.places[hits.place[k]].primitive);
    const PathState& state = hits.block.state(hits.place[k]);
    if (source == kNoIndex || !(state.pdf > 0.0f)) continue;
    area_pdfs[k] =
        lights.pmf<T>(source, state.scattered_at, state.normal) * lights.source(source).per_area;
    min_weights[k] = min_mis_weight(shading, lights.source(source));
  }
  const T area_pdf = load<T>(area_pdfs), min_weight = load<T>(min_weights);
  const Triple<T> way =
      (hits.surface.point - hits.path.scattered_at) * spread<T>(lights.per_unit());
  const T squared = dot(way, way);
  const T cosine = absolute(dot(hits.surface.flat_normal, way)) / root(squared);
  const T light_pdf = choose(cosine > 0.0f, area_pdf * squared / cosine, T{});
  const T mis_weight =
      choose((area_pdf > 0.0f) & (hits.path.pdf > 0.0f),
             maximum(power_heuristic(hits.path.pdf, light_pdf), min_weight), spread<T>(1.0f));
  return hits.path.throughput *
         (hits.emission() * (mis_weight * caustic_weights(shading, hits)) + hits.bsdf.unlit());
}

/// One light for each hit, chosen by what it may bring there.
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
    const SquarePoint<T> u = hits.random(kChooseLight);
    const auto high = unpack(u.x), low = unpack(u.y);
    const auto points = unpack(hits.surface.point), normals = unpack(hits.lit_normal());
    LightTree::Sample samples[kCount];
    for (int k = 0; k < kCount; ++k) {
      // Twice 24 bits: enough for a probability of one in many millions.
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
    const Triple<T> position =
        any_ball ? Lights::point_on<T>(middle, radius, hits.surface.point, hits.random(kLightPoint))
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
      // A lane without an area light samples one nevertheless, and nothing comes of it.
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

/// Next-event estimation: chooses one light for each hit, and samples it.
template <class T>
RAYGATE_INLINE void sample_one_light(const ShadingScene& shading, Hits<T>& hits,
                                     const LobeProbabilities<T>& lobes) {
  using Kind = Lights::Kind;
  const Lights& lights = shading.lights;
  const MaskOf<T> answers = hits.bsdf.answers_lights();
  if (!lights.any_power() || !any(answers)) return;
  const ChosenLights<T> chosen(lights, hits);
  IncidentLight<T> light;
  if (any(chosen.are(Kind::kPoint))) light.take(chosen.points(lights, hits));
  if (any(chosen.are(Kind::kDirection))) light.take(chosen.directions(hits));
  light.is_asked = light.is_asked & answers;
  const MaskOf<T> is_delta = light.is_asked;
  if (any(chosen.are(Kind::kEnvironment))) {
    light.take(chosen.environment(*lights.environment(), hits));
  }
  if (any(chosen.are(Kind::kArea))) light.take(chosen.areas(lights, hits));

  T mis_weight = spread<T>(1.0f);
  if (any(light.is_asked & !is_delta)) {  // scattered rays find it, too
    const T light_pdf =
        choose(light.is_area, light.pdf * light.distance_squared / light.light_cosine, light.pdf);
    const T bsdf_pdf = hits.bsdf.pdf(light.direction) * lobes.scatter_probability();
    const T least = shading.path.limits_mis_weight ? chosen.get(&Lights::Light::sky) : T{};
    mis_weight = choose((bsdf_pdf > kMinPdf) & !is_delta,
                        minimum(power_heuristic(light_pdf, bsdf_pdf), T(1.0f - least)), mis_weight);
  }
  const Triple<T> scattered = hits.bsdf.eval(light.direction, is_delta);
  add_light_sample(hits, 0, light, scattered_light(hits, light, scattered, mis_weight));
}

/// The ways of a hit back from where its rays go: what light paths and camera paths need to know of
/// each other (LightPaths). Light paths carry flux, whose throughput has the cosines of the other
/// sides of edges, and the BSDF as the camera's paths see it ("Robust Monte Carlo methods", 5.3).
template <bool kFromLight, class T>
struct WaysBack {
  T arrived;  ///< PathState::ratio at the hit
  T in;       ///< the cosine of the way there
  MaskOf<T> is_first;

  RAYGATE_INLINE WaysBack(const ShadingScene& shading, const Hits<T>& hits)
      : in(edge_cosine(hits, hits.surface.view)), is_first(hits.path.way == 1u) {
    T ratio = hits.path.ratio;
    if (!kFromLight) {
      const Triple<T> way =
          (hits.surface.point - hits.path.scattered_at) * spread<T>(shading.lights.per_unit());
      const T seen = shading.light_paths->camera_ratio(-hits.surface.view) * dot(way, way);
      ratio = choose(is_first, seen, ratio);
    }
    arrived = ratio / in;
  }

  /// After diffuse or glossy reflection.
  RAYGATE_INLINE void scatter(const Hits<T>& hits, const Triple<T>& throughput,
                              ScatteredRays<T>& next) const {
    const auto seen = hits.seen_from(next.direction);
    const T back =
        seen.bsdf.pdf(hits.surface.view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
    const T out = edge_cosine(hits, next.direction);
    const T known = kFromLight ? back : choose(is_first, spread<T>(1.0f), back);
    next.path.ratio = bounded(arrived * known * (out / next.path.pdf));
    if (!kFromLight) return;
    const T cosine = at_least(dot(seen.normal, hits.surface.view), 0.0f);
    const Triple<T> flux =
        throughput * seen.bsdf.eval(hits.surface.view) * (cosine * out / (in * next.path.pdf));
    next.path.throughput = choose(largest(next.path.throughput) > 0.0f, bounded(flux), zero<T>());
  }

  /// After a mirror or glass that bends, where `is_specular`; `eta` is 1 of mirrors. Where the
  /// normal was tilted for the view, there is no way back.
  RAYGATE_INLINE void mirror(const Hits<T>& hits, const MaskOf<T>& is_specular, const T& eta,
                             ScatteredRays<T>& next) const {
    const T out = edge_cosine(hits, next.direction);
    const auto has_back = !hits.surface.is_tilted();
    const T ratio = choose(has_back & (kFromLight ? has_back : !is_first), arrived * out, T{});
    next.path.ratio = choose(is_specular, ratio, next.path.ratio);
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

/// Sends one ray on: a lobe of the BSDF is chosen by its probability, then a direction of it.
template <bool kFromLight, class T>
RAYGATE_INLINE void sample_scattered_ray(const ShadingScene& shading, Hits<T>& hits,
                                         const LobeProbabilities<T>& lobes, Triple<T>& radiance) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const SquarePoint<T> choice = hits.random(kChooseLobe);
  Triple<T> throughput = hits.path.throughput;
  ScatteredRays<T> next(hits);
  next.is_wanted = lobes.sum > 0.0f;
  // Russian roulette comes before the lobe is chosen: no work is lost on rays that end.
  if (hits.block.batch->depth >= kRouletteDepth && shading.path.roulette_threshold > 0.0f) {
    const float per_threshold = 1.0f / shading.path.roulette_threshold;
    const T weight = kFromLight ? spread<T>(1.0f) : largest(throughput) * per_threshold;
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

  const bool has_ways_back = kFromLight || shading.light_paths != nullptr;
  std::optional<WaysBack<kFromLight, T>> ways_back;
  if (has_ways_back) ways_back.emplace(shading, hits);
  const bool has_rough_glass = bsdf.has_rough_glass();
  const bool has_choice = has_rough_glass || (hits.kind & kCoated) != 0;
  next.path.scattered_at = surface.point;
  next.path.normal = hits.lit_normal();
  next.path.way = WordOf<T>{};
  next.direction = next.flat = zero<T>();
  if (any(bsdf.scatters())) {
    next.direction = bsdf.sample(hits.random(kDirection), has_choice ? hits.random(kFacet).x : T{});
    next.flat = next.direction;
    next.path.pdf = bsdf.pdf(next.direction) * lobes.scatter_probability();
    const T cosine = hits.cosine(next.direction);
    const auto brings = (next.path.pdf > kMinPdf) & (cosine > 0.0f);
    next.path.throughput =
        choose(brings, bounded(throughput * bsdf.eval(next.direction) * (cosine / next.path.pdf)),
               zero<T>());
    if (has_rough_glass) {  // no light path goes through: PathState::ratio is 0 from here on
      if (kFromLight) return;
      next.is_transmitted = dot(surface.normal, next.direction) < 0.0f;
      next.is_wanted = next.is_wanted & brings;
      next.path.ratio = T{};
      next.send(hits, 0);
      return;
    }
    if (has_ways_back) ways_back->scatter(hits, throughput, next);
  }
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> reflected = reflect(surface.view, surface.normal);
    const Triple<T> reflected_throughput = throughput * bsdf.mirror() * (lobes.sum / lobes.mirror);
    next.direction = choose(is_mirrored, reflected, next.direction);
    next.flat = choose(is_mirrored, reflect(surface.view, surface.flat_normal), next.flat);
    next.path.throughput = choose(is_mirrored, reflected_throughput, next.path.throughput);
    next.path.pdf = choose(is_mirrored, T{}, next.path.pdf);
    next.path.way = choose(is_mirrored, hits.path.way_on(0), next.path.way);
    const auto shows_background = next.is_wanted & is_mirrored & !bsdf.mirror_is_traced();
    radiance = choose(shows_background,
                      radiance + reflected_throughput * sky(shading.lights, reflected), radiance);
    next.is_wanted = next.is_wanted & !shows_background;
  }
  if ((hits.kind & kTransmits) != 0) {
    const auto is_bent = next.is_transmitted & bsdf.is_refracting();
    const auto is_straight = next.is_transmitted & !bsdf.is_refracting();
    const Refraction<T> bent(surface.view, surface.normal, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    next.direction = choose(is_bent, bent.direction, next.direction);
    next.flat = choose(is_bent, flat.direction, next.flat);
    next.has_flat = next.has_flat & ((!is_bent) | flat.exists);
    next.is_wanted = next.is_wanted & ((!is_bent) | bent.exists);
    const Triple<T> transmitted_throughput =
        throughput * bsdf.transmission() * (lobes.sum / lobes.transmission);
    next.path.throughput =
        choose(next.is_transmitted, transmitted_throughput, next.path.throughput);
    next.path.pdf = choose(is_bent, T{}, next.path.pdf);
    // Straight on as if there were nothing.
    next.direction = choose(is_straight, -surface.view, next.direction);
    next.flat = choose(is_straight, -surface.view, next.flat);
    next.path.pdf = choose(is_straight, hits.path.pdf, next.path.pdf);
    next.path.scattered_at = choose(is_straight, hits.path.scattered_at, next.path.scattered_at);
    next.path.normal = choose(is_straight, hits.path.normal, next.path.normal);
    next.path.way =
        choose(is_straight, hits.path.way, choose(is_bent, hits.path.way_on(1), next.path.way));
  }
  if (has_ways_back) {
    const auto is_bent = next.is_transmitted & bsdf.is_refracting();
    const auto is_straight = next.is_transmitted & !bsdf.is_refracting();
    const T eta = choose(is_bent, bsdf.eta(), spread<T>(1.0f));
    ways_back->mirror(hits, is_mirrored | is_bent, eta, next);
    next.path.ratio = choose(is_straight, hits.path.ratio, next.path.ratio);
  }
  next.send(hits, 0);
}

/// Light that is on its way from a surface to the camera's lens; what surfaces scatter that is the
/// first on their path, light that is asked for finds.
template <class T>
RAYGATE_INLINE void connect_to_camera(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const auto scatters = hits.bsdf.scatters() & (hits.path.way != 1u);
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
  const T ratio = hits.path.ratio / in * pdf * pixels;
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
      sample_scattered_ray<false>(shading, hits, lobes, radiance);
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
    Triple<T> none = zero<T>();
    sample_scattered_ray<true>(shading, hits, LobeProbabilities<T>(hits.bsdf, hits.path.way == 1u),
                               none);
  });
}

}  // namespace raygate
