#include "host/light/path.h"

#include "host/light/in_lanes.h"

namespace raygate {
namespace {

// What random numbers and branches are for.
constexpr std::uint32_t kGoOn = 1, kChooseLight = 2, kLightPoint = 3, kChooseLobe = 4,
                        kDirection = 5, kFacet = 6;
constexpr int kSureSurfaces = 3;         // before chance decides whether a ray lives on
constexpr float kNothing = -1.0f;        // in place of a kind of lamp
constexpr float kLeastDensity = 1e-20f;  // of a direction: floats have room for the inverse

/// How likely each way on is, in proportion to what it brings.
template <class T>
struct LobeChances {
  T mirror, through, scatter, sum;

  RAYGATE_INLINE explicit LobeChances(const Bsdf<T>& bsdf)
      : mirror(largest(bsdf.mirror())),
        through(largest(bsdf.through())),
        scatter(largest(bsdf.diffuse() + bsdf.glossy())),
        sum(mirror + through + scatter) {}

  /// Of scattering; 0 where there is no way on at all.
  [[nodiscard]] RAYGATE_INLINE T share_of_scatter() const {
    return choose(sum > 0.0f, scatter / sum, T{});
  }
};

/// What a lamp's share is at least, of the two ways of finding it, where a scattered ray finds it:
/// beside the lamp such a ray meets the sky, and where the lamp's share of its light is as bright
/// as that, it is no matter of chance which of them it meets.
float least_share(const ShadingScene& shading, const Lights::Source& source) {
  return shading.techniques.evens_out ? shading.lights.lamp(source.lamp).sky : 0.0f;
}

/// What the surfaces emit. Lamps that a scattered ray has found count for the share of that way of
/// finding them.
template <class T>
RAYGATE_INLINE Triple<T> emitted(const ShadingScene& shading, const Hits<T>& hits) {
  const Lights& lights = shading.lights;
  Gathered<T, 2> places;
  for (int k = 0; k < Hits<T>::kCount; ++k) {
    const std::uint32_t source = lights.source_of(hits.block.places[hits.place[k]].slot);
    const Burden& burden = hits.block.burden(hits.place[k]);
    const bool was_asked = source != kNoIndex && burden.density > 0.0f;
    places.values[0][k] = was_asked ? lights.chance<T>(source, burden.scattered_at, burden.normal) *
                                          lights.source(source).per_area
                                    : 0.0f;
    places.values[1][k] = was_asked ? least_share(shading, lights.source(source)) : 0.0f;
  }
  const Triple<T> way = (hits.surface.point - hits.scattered_at) * spread<T>(lights.per_unit());
  const T squared = dot(way, way);
  const T cosine = absolute(dot(hits.surface.flat_normal, way)) / root(squared);
  const T asked = choose(cosine > 0.0f, places.one(0) * squared / cosine, T{});
  const T share = choose((places.one(0) > 0.0f) & (hits.density > 0.0f),
                         maximum(share_of(hits.density, asked), places.one(1)), spread<T>(1.0f));
  return hits.weight * (hits.bsdf.emission() * share + hits.bsdf.unlit());
}

template <class T>
RAYGATE_INLINE void ask_one_light(const ShadingScene& shading, Hits<T>& hits) {
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
    kRamp = 9,
    kKind = 11,
    kChance,
    kPlace,
    kLeast,
    kFields
  };
  Gathered<T, kFields> in;
  std::uint32_t lamps[kCount], patches[kCount];
  bool any_point = false, any_area = false, any_direction = false, any_spot = false,
       any_environment = false;
  for (int k = 0; k < kCount; ++k) {
    // Twice 24 bits: enough for a chance of one in many millions.
    const LightTree::Choice choice =
        lights.pick<T>(Hits<T>::triple_of(points, k), Hits<T>::triple_of(normals, k),
                       double{chosen[k]} + double{rest[k]} * 0x1p-24);
    if (choice.source == kNoIndex) {
      in.put(kLight, k, glm::vec3(0.0f));
      in.put(kPosition, k, glm::vec3(0.0f));
      in.values[kKind][k] = kNothing;
      in.values[kChance][k] = in.values[kPlace][k] = 1.0f;
      in.values[kLeast][k] = 0.0f;
      lamps[k] = 0;
      patches[k] = kNoIndex;
      continue;
    }
    const Lights::Source& source = lights.source(choice.source);
    lamps[k] = source.lamp;
    patches[k] = source.patch;
    const Lights::Lamp& lamp = lights.lamp(source.lamp);
    in.put(kLight, k, lamp.light);
    in.put(kPosition, k, lamp.position);
    in.values[kKind][k] = static_cast<float>(lamp.kind);
    in.values[kChance][k] = choice.chance;
    in.values[kPlace][k] = choice.chance * source.per_area;
    in.values[kLeast][k] = least_share(shading, source);
    any_point = any_point || lamp.kind == Lights::Kind::kPoint;
    any_area = any_area || lamp.kind == Lights::Kind::kArea;
    any_direction = any_direction || lamp.kind == Lights::Kind::kDirection;
    any_environment = any_environment || lamp.kind == Lights::Kind::kEnvironment;
    any_spot = any_spot || lamp.is_spot;
  }
  const T kinds = in.one(kKind);
  const auto is_a = [&](Lights::Kind kind)
                        RAYGATE_BODY { return kinds == spread<T>(static_cast<float>(kind)); };
  const LightPoint<T> place = {in.triple(kPosition), zero<T>(), WordOf<T>{} + NearestHit::kNone};
  if (any_point) {
    Triple<T> light = in.triple(kLight);
    if (any_spot) {
      for (int k = 0; k < kCount; ++k) {
        const SpotRamp& spot = lights.lamp(lamps[k]).spot;
        in.put(kAxis, k, spot.axis);
        in.values[kRamp][k] = spot.scale;
        in.values[kRamp + 1][k] = spot.offset;
      }
      light = light * spot_share(spot_cosine(hits, lights, place.position, in.triple(kAxis)),
                                 in.one(kRamp), in.one(kRamp + 1));
    }
    light = light_from_point(hits, lights, place.position, light, in.one(kChance));
    ask<T>(hits, 0, is_a(Lights::Kind::kPoint), light, lamps, place);
  }
  if (any_direction) {
    const Triple<T> light =
        light_from_direction(hits, place.position, hits.bsdf.scattered_from_point(place.position),
                             in.triple(kLight), in.one(kChance));
    ask<T>(hits, 0, is_a(Lights::Kind::kDirection), light, lamps, place);
  }
  if (any_environment) {
    const Environment& environment = *lights.environment();
    const Triple<T> towards = environment.sample<T>(hits.random(kLightPoint));
    const T asked = environment.density(towards) * in.one(kChance);
    const T scattered = hits.bsdf.density(towards) * LobeChances<T>(hits.bsdf).share_of_scatter();
    const Triple<T> light = light_from_direction(
        hits, towards, hits.bsdf.scattered(towards) * share_of(asked, scattered),
        environment.radiance(towards), asked);
    const auto is_environment = is_a(Lights::Kind::kEnvironment), scatters = hits.bsdf.scatters();
    ask<T>(hits, 0, is_environment & scatters & (asked > kLeastDensity), light, lamps,
           {towards, zero<T>(), place.slot});
  }
  if (!any_area) return;
  for (int k = 0; k < kCount; ++k) {
    // A lane without an area light samples one nevertheless, and nothing comes of it.
    if (patches[k] == kNoIndex) patches[k] = 0;
  }
  const LightPoint<T> point = lights.sample_patches<T>(patches, hits.random(kLightPoint));
  const WayToLight<T> way(lights, hits.surface, point.position);
  const T per_area = in.one(kPlace), cosine = absolute(dot(point.normal, way.direction));
  const T asked = per_area * way.squared / cosine;
  const T scattered =
      hits.bsdf.density(way.direction) * LobeChances<T>(hits.bsdf).share_of_scatter();
  const T share =
      choose(scattered > kLeastDensity, minimum(share_of(asked, scattered), 1.0f - in.one(kLeast)),
             spread<T>(1.0f));
  const Triple<T> weighted = in.triple(kLight) * (share / per_area);
  const auto is_area = is_a(Lights::Kind::kArea), scatters = hits.bsdf.scatters();
  ask<T>(hits, 0, is_area & scatters & (cosine > 0.0f), light_from_area(hits, way, point, weighted),
         lamps, point);
}

template <class T>
RAYGATE_INLINE void go_on_by_chance(const ShadingScene& shading, Hits<T>& hits,
                                    Triple<T>& radiance) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  const LobeChances<T> chances(bsdf);
  const SquarePoint<T> choice = hits.random(kChooseLobe);
  Triple<T> weight = hits.weight;
  WaysOn<T> ways;
  ways.is_wanted = chances.sum > 0.0f;
  // Chance decides before the lobe is looked at, so that no work is lost on rays that end.
  if (hits.block.wave->depth >= kSureSurfaces && shading.techniques.sure_weight > 0.0f) {
    const float per_sure_weight = 1.0f / shading.techniques.sure_weight;
    const T survival = at_most(largest(weight) * chances.sum * per_sure_weight, 1.0f);
    ways.is_wanted = ways.is_wanted & (choice.y < survival);
    weight = choose(ways.is_wanted, weight * (1.0f / survival), weight);
  }
  if (!any(ways.is_wanted)) return;
  const T u = choice.x * chances.sum;
  // Rough glass: its facet says what is mirrored.
  const bool has_rough_glass = bsdf.has_rough_glass();
  const T glass_chance = chances.mirror + chances.through;
  Triple<T> facet = surface.normal;
  T mirrored_up_to = chances.mirror;
  if (has_rough_glass) {
    const auto found = bsdf.facets().glass_facet(hits.random(kFacet));
    facet = found.normal;
    mirrored_up_to = found.reflectance * glass_chance;
  }
  const auto is_mirrored = u < mirrored_up_to;
  ways.is_through = (!is_mirrored) & (u < chances.mirror + chances.through);
  ways.has_flat = is_mirrored | ways.is_through;
  if (has_rough_glass) ways.has_flat = ways.has_flat & !ways.has_flat;
  ways.stream = mixed(hits.stream, kGoOn);

  ways.direction = bsdf.sample(hits.random(kDirection));
  ways.flat = ways.direction;
  ways.density = bsdf.density(ways.direction) * chances.share_of_scatter();
  ways.scattered_at = surface.point;
  ways.normal = surface.normal;
  const T cosine = at_least(dot(surface.normal, ways.direction), 0.0f);
  const auto brings =
      (ways.density > kLeastDensity) & (dot(surface.flat_normal, ways.direction) > 0.0f);
  ways.weight =
      choose(brings, bounded(weight * bsdf.scattered(ways.direction) * (cosine / ways.density)),
             zero<T>());
  if ((hits.kind & kMirrors) != 0) {
    const Triple<T> mirrored_way = mirrored(surface.view, facet);
    Triple<T> mirrored_weight = weight * bsdf.mirror() * (chances.sum / chances.mirror);
    if (has_rough_glass) {
      const FacetLobes<T>& facets = bsdf.facets();
      mirrored_weight = weight * (facets.glass * facets.mirrored_share(mirrored_way) *
                                  (chances.sum / glass_chance));
    }
    ways.direction = choose(is_mirrored, mirrored_way, ways.direction);
    ways.flat = choose(is_mirrored, mirrored(surface.view, surface.flat_normal), ways.flat);
    ways.weight = choose(is_mirrored, mirrored_weight, ways.weight);
    ways.density = choose(is_mirrored, T{}, ways.density);
    const auto shows_background = ways.is_wanted & is_mirrored & !bsdf.mirror_is_traced();
    radiance = choose(shows_background,
                      radiance + mirrored_weight * sky(shading.lights, mirrored_way), radiance);
    ways.is_wanted = ways.is_wanted & !shows_background;
  }
  if ((hits.kind & kLetsThrough) != 0) {
    const auto is_bent = ways.is_through & bsdf.is_refracting();
    const auto is_straight = ways.is_through & !bsdf.is_refracting();
    const Refraction<T> bent(surface.view, facet, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    ways.direction = choose(is_bent, bent.direction, ways.direction);
    ways.flat = choose(is_bent, flat.direction, ways.flat);
    ways.has_flat = ways.has_flat & ((!is_bent) | flat.exists);
    ways.is_wanted = ways.is_wanted & ((!is_bent) | bent.exists);
    Triple<T> through_weight = weight * bsdf.through() * (chances.sum / chances.through);
    if (has_rough_glass) {
      const FacetLobes<T>& facets = bsdf.facets();
      through_weight =
          weight * facets.tint *
          (facets.glass * facets.through_share(bent.direction) * (chances.sum / glass_chance));
    }
    ways.weight = choose(ways.is_through, through_weight, ways.weight);
    ways.density = choose(is_bent, T{}, ways.density);
    // Straight on as if there were nothing.
    ways.direction = choose(is_straight, -surface.view, ways.direction);
    ways.flat = choose(is_straight, -surface.view, ways.flat);
    ways.density = choose(is_straight, hits.density, ways.density);
    ways.scattered_at = choose(is_straight, hits.scattered_at, ways.scattered_at);
    ways.normal = choose(is_straight, hits.scattering_normal, ways.normal);
  }
  ways.send(hits, 0);
}

}  // namespace

void Path::shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) {
  const ShadingScene& shading = shading_;
  in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.density)>;
    Triple<T> radiance = zero<T>();
    if ((kind & kEmits) != 0) radiance = emitted(shading, hits);
    if (block.wave->depth <= shading.max_depth) {
      if (shading.lights.any_power()) ask_one_light(shading, hits);
      go_on_by_chance(shading, hits, radiance);
    }
    hits.set_radiance(radiance);
  });
}

}  // namespace raygate
