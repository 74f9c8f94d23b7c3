#include "host/light/path.h"

#include "host/light/in_lanes.h"

namespace raygate {
namespace {

// What random numbers and branches are for.
constexpr std::uint32_t kNextRay = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                        kDirection = 5, kFacet = 6;
constexpr int kRouletteDepth = 3;  // before chance decides whether a ray lives on
constexpr float kNothing = -1.0f;  // in place of a kind of light
constexpr float kMinPdf = 1e-20f;  // of a direction: floats have room for the inverse

/// How likely each way on is, in proportion to what it brings.
template <class T>
struct LobeProbabilities {
  T mirror, transmission, scatter, sum;

  RAYGATE_INLINE explicit LobeProbabilities(const Bsdf<T>& bsdf)
      : mirror(largest(bsdf.mirror())),
        transmission(largest(bsdf.transmission())),
        scatter(largest(bsdf.diffuse() + bsdf.glossy())),
        sum(mirror + transmission + scatter) {}

  /// Of scattering; 0 where there is no way on at all.
  [[nodiscard]] RAYGATE_INLINE T scatter_probability() const {
    return choose(sum > 0.0f, scatter / sum, T{});
  }
};

/// What a light's share is at least, of the two ways of finding it, where a scattered ray finds it:
/// beside the light such a ray meets the sky, and where the light's share of its light is as bright
/// as that, it is no matter of chance which of them it meets.
float min_mis_weight(const ShadingScene& shading, const Lights::Source& source) {
  return shading.path.limits_mis_weight ? shading.lights.light(source.light).sky : 0.0f;
}

/// What the surfaces emit. Lights that a scattered ray has found count for the share of that way of
/// finding them.
template <class T>
RAYGATE_INLINE Triple<T> emitted_radiance(const ShadingScene& shading, const Hits<T>& hits) {
  const Lights& lights = shading.lights;
  Gathered<T, 2> places;
  for (int k = 0; k < Hits<T>::kCount; ++k) {
    const std::uint32_t source = lights.source_of(hits.block.places[hits.place[k]].primitive);
    const PathState& state = hits.block.state(hits.place[k]);
    const bool was_asked = source != kNoIndex && state.pdf > 0.0f;
    places.values[0][k] = was_asked ? lights.pmf<T>(source, state.scattered_at, state.normal) *
                                          lights.source(source).per_area
                                    : 0.0f;
    places.values[1][k] = was_asked ? min_mis_weight(shading, lights.source(source)) : 0.0f;
  }
  const Triple<T> way = (hits.surface.point - hits.scattered_at) * spread<T>(lights.per_unit());
  const T squared = dot(way, way);
  const T cosine = absolute(dot(hits.surface.flat_normal, way)) / root(squared);
  const T asked = choose(cosine > 0.0f, places.one(0) * squared / cosine, T{});
  const T share = choose((places.one(0) > 0.0f) & (hits.pdf > 0.0f),
                         maximum(power_heuristic(hits.pdf, asked), places.one(1)), spread<T>(1.0f));
  return hits.throughput * (hits.bsdf.emission() * share + hits.bsdf.unlit());
}

template <class T>
RAYGATE_INLINE void sample_one_light(const ShadingScene& shading, Hits<T>& hits) {
  constexpr int kCount = Hits<T>::kCount;
  const Lights& lights = shading.lights;
  const SquarePoint<T> u = hits.random(kChooseLight);
  float chosen[kCount], rest[kCount];
  lanes_to(chosen, u.x);
  lanes_to(rest, u.y);
  const Gathered<T, 3> points = Hits<T>::spread_out(hits.surface.point),
                       normals = Hits<T>::spread_out(hits.surface.normal);
  enum : std::uint8_t {
    kLight,
    kPosition = 3,
    kAxis = 6,
    kFalloff = 9,
    kKind = 11,
    kChance,
    kPlace,
    kLeast,
    kFields
  };
  Gathered<T, kFields> in;
  std::uint32_t indices[kCount], patches[kCount];
  bool any_point = false, any_area = false, any_direction = false, any_spot = false,
       any_environment = false;
  for (int k = 0; k < kCount; ++k) {
    // Twice 24 bits: enough for a chance of one in many millions.
    const LightTree::Sample choice =
        lights.sample_source<T>(Hits<T>::triple_of(points, k), Hits<T>::triple_of(normals, k),
                                double{chosen[k]} + double{rest[k]} * 0x1p-24);
    if (choice.source == kNoIndex) {
      in.put(kLight, k, glm::vec3(0.0f));
      in.put(kPosition, k, glm::vec3(0.0f));
      in.values[kKind][k] = kNothing;
      in.values[kChance][k] = in.values[kPlace][k] = 1.0f;
      in.values[kLeast][k] = 0.0f;
      indices[k] = 0;
      patches[k] = kNoIndex;
      continue;
    }
    const Lights::Source& source = lights.source(choice.source);
    indices[k] = source.light;
    patches[k] = source.patch;
    const Lights::Light& light_record = lights.light(source.light);
    in.put(kLight, k, light_record.emission);
    in.put(kPosition, k, light_record.position);
    in.values[kKind][k] = static_cast<float>(light_record.kind);
    in.values[kChance][k] = choice.pmf;
    in.values[kPlace][k] = choice.pmf * source.per_area;
    in.values[kLeast][k] = min_mis_weight(shading, source);
    any_point = any_point || light_record.kind == Lights::Kind::kPoint;
    any_area = any_area || light_record.kind == Lights::Kind::kArea;
    any_direction = any_direction || light_record.kind == Lights::Kind::kDirection;
    any_environment = any_environment || light_record.kind == Lights::Kind::kEnvironment;
    any_spot = any_spot || light_record.is_spot;
  }
  const T kinds = in.one(kKind);
  const auto is_a = [&](Lights::Kind kind)
                        RAYGATE_BODY { return kinds == spread<T>(static_cast<float>(kind)); };
  const LightPoint<T> place = {in.triple(kPosition), zero<T>(), WordOf<T>{} + NearestHit::kNone};
  if (any_point) {
    Triple<T> light = in.triple(kLight);
    if (any_spot) {
      for (int k = 0; k < kCount; ++k) {
        const SpotFalloff& spot = lights.light(indices[k]).spot;
        in.put(kAxis, k, spot.axis);
        in.values[kFalloff][k] = spot.scale;
        in.values[kFalloff + 1][k] = spot.offset;
      }
      light = light * spot_falloff(spot_cosine(hits, lights, place.position, in.triple(kAxis)),
                                   in.one(kFalloff), in.one(kFalloff + 1));
    }
    light = point_light_contribution(hits, lights, place.position, light, in.one(kChance));
    add_light_sample<T>(hits, 0, is_a(Lights::Kind::kPoint), light, indices, place);
  }
  if (any_direction) {
    const Triple<T> light = directional_light_contribution(
        hits, place.position, hits.bsdf.eval_for_point_light(place.position), in.triple(kLight),
        in.one(kChance));
    add_light_sample<T>(hits, 0, is_a(Lights::Kind::kDirection), light, indices, place);
  }
  if (any_environment) {
    const Environment& environment = *lights.environment();
    const Triple<T> towards = environment.sample<T>(hits.random(kLightPoint));
    const T asked = environment.pdf(towards) * in.one(kChance);
    const T scattered =
        hits.bsdf.pdf(towards) * LobeProbabilities<T>(hits.bsdf).scatter_probability();
    const Triple<T> light = directional_light_contribution(
        hits, towards, hits.bsdf.eval(towards) * power_heuristic(asked, scattered),
        environment.radiance(towards), asked);
    const auto is_environment = is_a(Lights::Kind::kEnvironment), scatters = hits.bsdf.scatters();
    add_light_sample<T>(hits, 0, is_environment & scatters & (asked > kMinPdf), light, indices,
                        {towards, zero<T>(), place.primitive});
  }
  if (!any_area) return;
  for (int k = 0; k < kCount; ++k) {
    // A lane without an area light samples one nevertheless, and nothing comes of it.
    if (patches[k] == kNoIndex) patches[k] = 0;
  }
  const LightPoint<T> point = lights.sample_patches<T>(patches, hits.random(kLightPoint));
  const DirectionToLight<T> to_light(lights, hits.surface, point.position);
  const T per_area = in.one(kPlace), cosine = absolute(dot(point.normal, to_light.direction));
  const T asked = per_area * to_light.distance_squared / cosine;
  const T scattered =
      hits.bsdf.pdf(to_light.direction) * LobeProbabilities<T>(hits.bsdf).scatter_probability();
  const T share =
      choose(scattered > kMinPdf, minimum(power_heuristic(asked, scattered), 1.0f - in.one(kLeast)),
             spread<T>(1.0f));
  const Triple<T> weighted = in.triple(kLight) * (share / per_area);
  const auto is_area = is_a(Lights::Kind::kArea), scatters = hits.bsdf.scatters();
  add_light_sample<T>(hits, 0, is_area & scatters & (cosine > 0.0f),
                      area_light_contribution(hits, to_light, point, weighted), indices, point);
}

template <class T>
RAYGATE_INLINE void sample_scattered_ray(const ShadingScene& shading, Hits<T>& hits,
                                         Triple<T>& radiance) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const LobeProbabilities<T> lobes(bsdf);
  const SquarePoint<T> choice = hits.random(kChooseLobe);
  Triple<T> throughput = hits.throughput;
  ScatteredRays<T> next;
  next.is_wanted = lobes.sum > 0.0f;
  // Chance decides before the lobe is looked at, so that no work is lost on rays that end.
  if (hits.block.batch->depth >= kRouletteDepth && shading.path.roulette_threshold > 0.0f) {
    const float per_threshold = 1.0f / shading.path.roulette_threshold;
    const T survival = at_most(largest(throughput) * lobes.sum * per_threshold, 1.0f);
    next.is_wanted = next.is_wanted & (choice.y < survival);
    throughput = choose(next.is_wanted, throughput * (1.0f / survival), throughput);
  }
  if (!any(next.is_wanted)) return;
  const T u = choice.x * lobes.sum;
  // Rough glass: its facet says what is mirrored.
  const bool has_rough_glass = bsdf.has_rough_glass();
  const T glass_chance = lobes.mirror + lobes.transmission;
  Triple<T> facet = surface.normal;
  T mirrored_up_to = lobes.mirror;
  if (has_rough_glass) {
    const auto found = bsdf.facets().sample_glass_facet(hits.random(kFacet));
    facet = found.normal;
    mirrored_up_to = found.reflectance * glass_chance;
  }
  const auto is_mirrored = u < mirrored_up_to;
  next.is_transmitted = (!is_mirrored) & (u < lobes.mirror + lobes.transmission);
  next.has_flat = is_mirrored | next.is_transmitted;
  if (has_rough_glass) next.has_flat = next.has_flat & !next.has_flat;
  next.stream = hash(hits.stream, kNextRay);

  next.direction = bsdf.sample(hits.random(kDirection));
  next.flat = next.direction;
  next.pdf = bsdf.pdf(next.direction) * lobes.scatter_probability();
  next.scattered_at = surface.point;
  next.normal = surface.normal;
  const T cosine = at_least(dot(surface.normal, next.direction), 0.0f);
  const auto brings = (next.pdf > kMinPdf) & (dot(surface.flat_normal, next.direction) > 0.0f);
  next.throughput = choose(
      brings, bounded(throughput * bsdf.eval(next.direction) * (cosine / next.pdf)), zero<T>());
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> reflected = reflect(surface.view, facet);
    Triple<T> reflected_throughput = throughput * bsdf.mirror() * (lobes.sum / lobes.mirror);
    if (has_rough_glass) {
      const MetallicRoughnessLobes<T>& facets = bsdf.facets();
      reflected_throughput =
          throughput * (facets.glass * facets.g2_over_g1(reflected) * (lobes.sum / glass_chance));
    }
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
    const Refraction<T> bent(surface.view, facet, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    next.direction = choose(is_bent, bent.direction, next.direction);
    next.flat = choose(is_bent, flat.direction, next.flat);
    next.has_flat = next.has_flat & ((!is_bent) | flat.exists);
    next.is_wanted = next.is_wanted & ((!is_bent) | bent.exists);
    Triple<T> transmitted_throughput =
        throughput * bsdf.transmission() * (lobes.sum / lobes.transmission);
    if (has_rough_glass) {
      const MetallicRoughnessLobes<T>& facets = bsdf.facets();
      transmitted_throughput =
          throughput * facets.tint *
          (facets.glass * facets.g1(bent.direction) * (lobes.sum / glass_chance));
    }
    next.throughput = choose(next.is_transmitted, transmitted_throughput, next.throughput);
    next.pdf = choose(is_bent, T{}, next.pdf);
    // Straight on as if there were nothing.
    next.direction = choose(is_straight, -surface.view, next.direction);
    next.flat = choose(is_straight, -surface.view, next.flat);
    next.pdf = choose(is_straight, hits.pdf, next.pdf);
    next.scattered_at = choose(is_straight, hits.scattered_at, next.scattered_at);
    next.normal = choose(is_straight, hits.scattering_normal, next.normal);
  }
  next.send(hits, 0);
}

}  // namespace

void Path::shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) {
  const ShadingScene& shading = shading_;
  shade_in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.pdf)>;
    Triple<T> radiance = zero<T>();
    if ((kind & kEmits) != 0) radiance = emitted_radiance(shading, hits);
    if (block.batch->depth <= shading.max_depth) {
      if (shading.lights.any_power()) sample_one_light(shading, hits);
      sample_scattered_ray(shading, hits, radiance);
    }
    hits.set_radiance(radiance);
  });
}

}  // namespace raygate
