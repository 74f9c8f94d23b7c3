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

const Lights::Source kNoSource{.per_area = 1.0f};

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
  const Triple<T> way = (hits.surface.point - hits.scattered_at) * spread<T>(lights.per_unit());
  const T squared = dot(way, way);
  const T cosine = absolute(dot(hits.surface.flat_normal, way)) / root(squared);
  const T light_pdf = choose(cosine > 0.0f, area_pdf * squared / cosine, T{});
  const T mis_weight =
      choose((area_pdf > 0.0f) & (hits.pdf > 0.0f),
             maximum(power_heuristic(hits.pdf, light_pdf), min_weight), spread<T>(1.0f));
  return hits.throughput *
         (hits.bsdf.emission() * (mis_weight * caustic_weights(shading, hits)) + hits.bsdf.unlit());
}

/// Next-event estimation: chooses one light for each hit, and samples it.
template <class T>
RAYGATE_INLINE void sample_one_light(const ShadingScene& shading, Hits<T>& hits,
                                     const LobeProbabilities<T>& lobes) {
  constexpr int kCount = Hits<T>::kCount;
  using Kind = Lights::Kind;
  const Lights& lights = shading.lights;
  const SquarePoint<T> u = hits.random(kChooseLight);
  const auto high = unpack(u.x), low = unpack(u.y);
  const auto points = unpack(hits.surface.point), normals = unpack(hits.lit_normal());
  const Lights::Source* sources[kCount];
  const Lights::Light* chosen[kCount];
  std::uint32_t indices[kCount];
  float pmfs[kCount];
  static const Lights::Light no_light{.kind = Lights::Kind::kNone, .spot = {}};
  for (int k = 0; k < kCount; ++k) {
    // Twice 24 bits: enough for a probability of one in many millions.
    const LightTree::Sample sample =
        lights.sample_source<T>(points[k], normals[k], double{high[k]} + double{low[k]} * 0x1p-24);
    const bool is_any = sample.source != kNoIndex;
    sources[k] = is_any ? &lights.source(sample.source) : &kNoSource;
    indices[k] = sources[k]->light;
    chosen[k] = is_any ? &lights.light(indices[k]) : &no_light;
    pmfs[k] = is_any ? sample.pmf : 1.0f;
  }
  const WordOf<T> kinds =
      gather<T>([&](int k) RAYGATE_BODY { return static_cast<std::uint32_t>(chosen[k]->kind); });
  const auto is_a = [&](Kind kind)
                        RAYGATE_BODY { return kinds == static_cast<std::uint32_t>(kind); };
  const T pmf = load<T>(pmfs);
  const Triple<T> emission = gather<T>(chosen, &Lights::Light::emission);
  const LightPoint<T> place = {gather<T>(chosen, &Lights::Light::position), zero<T>(),
                               WordOf<T>{} + NearestHit::kNone};
  if (any(is_a(Kind::kPoint))) {
    Triple<T> intensity = emission;
    const T radius = gather<T>(chosen, &Lights::Light::radius);
    Triple<T> position = place.position;
    if (any(radius > 0.0f)) {
      position =
          Lights::point_on<T>(position, radius, hits.surface.point, hits.random(kLightPoint));
    }
    if (any(gather<T>(chosen, &Lights::Light::is_spot))) {
      const auto axis = gather<T>([&](int k) RAYGATE_BODY { return chosen[k]->spot.axis; });
      const T scale = gather<T>([&](int k) RAYGATE_BODY { return chosen[k]->spot.scale; });
      const T offset = gather<T>([&](int k) RAYGATE_BODY { return chosen[k]->spot.offset; });
      intensity =
          intensity * spot_falloff(spot_cosine(hits, lights, place.position, axis), scale, offset);
    }
    const Triple<T> towards = position - hits.surface.point;
    add_light_sample<T>(hits, 0, is_a(Kind::kPoint), towards,
                        point_light_contribution(hits, lights, position, intensity, pmf), indices,
                        {towards, zero<T>(), place.primitive});
  }
  if (any(is_a(Kind::kDirection))) {
    const Triple<T> light = directional_light_contribution(
        hits, place.position, hits.bsdf.eval_for_point_light(place.position), emission, pmf);
    add_light_sample<T>(hits, 0, is_a(Kind::kDirection), place.position, light, indices, place);
  }
  const auto scatters = hits.bsdf.scatters();
  if (const auto is_environment = is_a(Kind::kEnvironment); any(is_environment)) {
    const Environment& environment = *lights.environment();
    const Triple<T> towards = environment.sample<T>(hits.random(kLightPoint));
    const T light_pdf = environment.pdf(towards) * pmf;
    const T bsdf_pdf = hits.bsdf.pdf(towards) * lobes.scatter_probability();
    const Triple<T> light = directional_light_contribution(
        hits, towards, hits.bsdf.eval(towards) * power_heuristic(light_pdf, bsdf_pdf),
        environment.radiance(towards), light_pdf);
    const auto is_valid = scatters & is_environment & (light_pdf > kMinPdf);
    add_light_sample<T>(hits, 0, is_valid, towards, light, indices,
                        {towards, zero<T>(), place.primitive});
  }
  const auto is_area = is_a(Kind::kArea);
  if (!any(is_area)) return;
  std::uint32_t patches[kCount];
  for (int k = 0; k < kCount; ++k) {
    // A lane without an area light samples one nevertheless, and nothing comes of it.
    patches[k] = sources[k]->patch == kNoIndex ? 0 : sources[k]->patch;
  }
  const LightPoint<T> point = lights.sample_patches<T>(patches, hits.random(kLightPoint));
  const DirectionToLight<T> to_light(lights, hits, point.position);
  const T area_pdf = pmf * gather<T>(sources, &Lights::Source::per_area);
  const T cosine = absolute(dot(point.normal, to_light.direction));
  const T light_pdf = area_pdf * to_light.distance_squared / cosine;
  const T bsdf_pdf = hits.bsdf.pdf(to_light.direction) * lobes.scatter_probability();
  const T min_bsdf_weight =
      gather<T>([&](int k) RAYGATE_BODY { return min_mis_weight(shading, *sources[k]); });
  const T mis_weight = choose(bsdf_pdf > kMinPdf,
                              minimum(power_heuristic(light_pdf, bsdf_pdf), 1.0f - min_bsdf_weight),
                              spread<T>(1.0f));
  add_light_sample<T>(
      hits, 0, is_area & scatters & (cosine > 0.0f), to_light.direction,
      area_light_contribution(hits, to_light, point,
                              lights.radiance_at<T>(chosen, point) * (mis_weight / area_pdf)),
      indices, point);
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
      : in(edge_cosine(hits, hits.surface.view)), is_first(hits.vertices == 0u) {
    arrived = hits.ratio / in;
    if (kFromLight) return;
    const Triple<T> way =
        (hits.surface.point - hits.scattered_at) * spread<T>(shading.lights.per_unit());
    arrived = arrived * choose(is_first, dot(way, way), spread<T>(1.0f));
  }

  /// After diffuse or glossy reflection.
  RAYGATE_INLINE void scatter(const Hits<T>& hits, const Triple<T>& throughput,
                              ScatteredRays<T>& next) const {
    const auto seen = hits.seen_from(next.direction);
    const T back =
        seen.bsdf.pdf(hits.surface.view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
    const T out = edge_cosine(hits, next.direction);
    const T known = kFromLight ? back : choose(is_first, spread<T>(1.0f), back);
    next.ratio = bounded(arrived * known * (out / next.pdf));
    if (!kFromLight) return;
    const T cosine = at_least(dot(seen.normal, hits.surface.view), 0.0f);
    const Triple<T> flux =
        throughput * seen.bsdf.eval(hits.surface.view) * (cosine * out / (in * next.pdf));
    next.throughput = choose(largest(next.throughput) > 0.0f, bounded(flux), zero<T>());
  }

  /// After a mirror or glass that bends, where `is_specular`; `eta` is 1 of mirrors. Where the
  /// normal was tilted for the view, there is no way back.
  RAYGATE_INLINE void mirror(const Hits<T>& hits, const MaskOf<T>& is_specular, const T& eta,
                             ScatteredRays<T>& next) const {
    const T out = edge_cosine(hits, next.direction);
    const auto has_back = !hits.surface.is_tilted();
    const T ratio = choose(has_back & (kFromLight ? has_back : !is_first), arrived * out, T{});
    next.ratio = choose(is_specular, ratio, next.ratio);
    if (!kFromLight) return;
    const T facing = absolute(dot(hits.surface.normal, hits.surface.view));
    const T leaving = at_least(absolute(dot(hits.surface.normal, next.direction)), kLeastCosine);
    const T scale = out * facing / (in * leaving * eta * eta);
    next.throughput = choose(is_specular, bounded(next.throughput * scale), next.throughput);
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
  Triple<T> throughput = hits.throughput;
  ScatteredRays<T> next;
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
  next.stream = hash(hits.stream, kNextRay);

  const bool has_rough_glass = bsdf.has_rough_glass();
  const bool has_choice = has_rough_glass || (hits.kind & kCoated) != 0;
  next.direction = bsdf.sample(hits.random(kDirection), has_choice ? hits.random(kFacet).x : T{});
  next.flat = next.direction;
  next.pdf = bsdf.pdf(next.direction) * lobes.scatter_probability();
  next.scattered_at = surface.point;
  next.normal = hits.lit_normal();
  const T cosine = hits.cosine(next.direction);
  const auto brings = (next.pdf > kMinPdf) & (cosine > 0.0f);
  next.throughput = choose(
      brings, bounded(throughput * bsdf.eval(next.direction) * (cosine / next.pdf)), zero<T>());
  if (has_rough_glass) {  // no light path goes through: PathState::ratio is 0 from here on
    if (kFromLight) return;
    next.is_transmitted = dot(surface.normal, next.direction) < 0.0f;
    next.is_wanted = next.is_wanted & brings;
    next.send(hits, 0);
    return;
  }
  const bool has_ways_back = kFromLight || shading.light_paths != nullptr;
  if (has_ways_back) WaysBack<kFromLight, T>(shading, hits).scatter(hits, throughput, next);
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> reflected = reflect(surface.view, surface.normal);
    const Triple<T> reflected_throughput = throughput * bsdf.mirror() * (lobes.sum / lobes.mirror);
    next.direction = choose(is_mirrored, reflected, next.direction);
    next.flat = choose(is_mirrored, reflect(surface.view, surface.flat_normal), next.flat);
    next.throughput = choose(is_mirrored, reflected_throughput, next.throughput);
    next.pdf = choose(is_mirrored, T{}, next.pdf);
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
    next.throughput = choose(next.is_transmitted, transmitted_throughput, next.throughput);
    next.pdf = choose(is_bent, T{}, next.pdf);
    // Straight on as if there were nothing.
    next.direction = choose(is_straight, -surface.view, next.direction);
    next.flat = choose(is_straight, -surface.view, next.flat);
    next.pdf = choose(is_straight, hits.pdf, next.pdf);
    next.scattered_at = choose(is_straight, hits.scattered_at, next.scattered_at);
    next.normal = choose(is_straight, hits.scattering_normal, next.normal);
  }
  if (has_ways_back) {
    const auto is_bent = next.is_transmitted & bsdf.is_refracting();
    const auto is_straight = next.is_transmitted & !bsdf.is_refracting();
    const T eta = choose(is_bent, bsdf.eta(), spread<T>(1.0f));
    WaysBack<kFromLight, T>(shading, hits).mirror(hits, is_mirrored | is_bent, eta, next);
    next.ratio = choose(is_straight, hits.ratio, next.ratio);
    next.vertices = choose(is_straight, hits.vertices, hits.vertices + 1u);
  }
  next.send(hits, 0);
}

/// Light that is on its way from a surface to the camera's lens; what surfaces scatter that is the
/// first on their path, light that is asked for finds.
template <class T>
RAYGATE_INLINE void connect_to_camera(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const auto scatters = hits.bsdf.scatters() & (hits.vertices != 0u);
  if (!any(scatters) || hits.bsdf.has_rough_glass()) return;
  const SquarePoint<T> u = hits.random(kLens);
  const auto x = unpack(u.x), y = unpack(u.y);
  const auto points = unpack(hits.surface.point);
  LightPaths::View views[kCount];
  for (int k = 0; k < kCount; ++k) views[k] = shading.light_paths->view_of(points[k], {x[k], y[k]});
  const Triple<T> lens =
      gather<T>([&](int k) RAYGATE_BODY -> const glm::vec3& { return views[k].lens; });
  const T per_area = gather<T>([&](int k) RAYGATE_BODY { return views[k].per_area; });
  const DirectionToLight<T> way(shading.lights, hits, lens);
  const auto seen = hits.seen_from(way.direction);
  const Triple<T>& view = hits.surface.view;
  const T pixels = per_area * edge_cosine(hits, way.direction);
  const T in = edge_cosine(hits, view);
  const T pdf = seen.bsdf.pdf(view) * LobeProbabilities<T>(seen.bsdf).scatter_probability();
  const T ratio = hits.ratio / in * pdf * pixels;
  const T mis_weight = 1.0f / (1.0f + ratio * ratio);
  const T cosine = at_least(dot(seen.normal, view), 0.0f);
  const Triple<T> light =
      hits.throughput * seen.bsdf.eval(view) * (cosine / in * pixels * mis_weight);
  std::uint32_t indices[kCount];
  for (std::uint32_t& index : indices) index = kNoIndex;
  add_light_sample<T>(hits, 0, scatters & (way.cosine > 0.0f) & (per_area > 0.0f), way.direction,
                      bounded(light), indices, {lens, view, WordOf<T>{} + NearestHit::kNone});
}

}  // namespace

void shade_path(const ShadingScene& shading, HitBlock& block, HitKind kind,
                std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.pdf)>;
    Triple<T> radiance = zero<T>();
    if ((kind & kEmits) != 0) radiance = emitted_radiance(shading, hits);
    if (block.batch->depth <= shading.max_depth) {
      const LobeProbabilities<T> lobes(hits.bsdf);
      if (shading.lights.any_power()) sample_one_light(shading, hits, lobes);
      sample_scattered_ray<false>(shading, hits, lobes, radiance);
    }
    hits.set_radiance(radiance);
  });
}

void shade_light_path(const ShadingScene& shading, HitBlock& block, HitKind kind,
                      std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.pdf)>;
    connect_to_camera(shading, hits);
    hits.set_radiance(zero<T>());
    if (block.batch->depth > shading.max_depth) return;
    Triple<T> none = zero<T>();
    sample_scattered_ray<true>(shading, hits, LobeProbabilities<T>(hits.bsdf, hits.vertices == 0u),
                               none);
  });
}

}  // namespace raygate
