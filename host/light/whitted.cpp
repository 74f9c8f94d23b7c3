#include "host/light/whitted.h"

#include "host/light/in_lanes.h"

namespace raygate {
namespace {

// What random numbers and branches are for.
constexpr std::uint32_t kMirror = 1, kThrough = 2, kFacet = 3, kFirstAreaLight = 16;
constexpr float kNarrow = 0.25f;  // alpha: what wider facets reflect counts as ambient light

/// Whether rays are sent for what rough facets reflect.
template <class T>
RAYGATE_INLINE bool has_rough_facets(const Hits<T>& hits) {
  return (~hits.kind & (kFacets | kGlossy)) == 0;
}
/// In which lanes.
template <class T>
RAYGATE_INLINE MaskOf<T> is_narrow(const Hits<T>& hits) {
  return !(hits.bsdf.facets().ggx.squared > kNarrow * kNarrow);
}

template <class T>
RAYGATE_INLINE void ask_all_lights(const ShadingScene& shading, Hits<T>& hits) {
  const Lights& lights = shading.lights;
  const T one = spread<T>(1.0f);
  std::uint32_t lamps[Hits<T>::kCount];
  const std::size_t points = lights.points().size();
  const WordOf<T> no_slot = WordOf<T>{} + NearestHit::kNone;
  for (std::uint32_t i = 0; i < lights.count(); ++i) {
    const Lights::Lamp& lamp = lights.lamp(i);
    for (std::uint32_t& number : lamps) number = i;
    const Triple<T> position = spread<T>(lamp.position);
    Triple<T> light = spread<T>(lamp.light);
    if (lamp.kind == Lights::Kind::kPoint) {
      if (lamp.is_spot) {
        light = light * spot_share(spot_cosine(hits, lights, position, spread<T>(lamp.spot.axis)),
                                   spread<T>(lamp.spot.scale), spread<T>(lamp.spot.offset));
      }
      ask<T>(hits, i, one > 0.0f, light_from_point(hits, lights, position, light, one), lamps,
             {position, zero<T>(), no_slot});
      continue;
    }
    if (lamp.kind == Lights::Kind::kDirection) {
      ask<T>(hits, i, one > 0.0f,
             light_from_direction(hits, position, hits.bsdf.scattered_from_point(position), light,
                                  one),
             lamps, {position, zero<T>(), no_slot});
      continue;
    }
    if (lamp.kind == Lights::Kind::kEnvironment) continue;  // it is the ambient light
    const auto scatters = hits.bsdf.scatters();
    if (!any(scatters)) continue;
    const AreaLight& area = lights.areas()[i - points];
    const auto number = static_cast<std::uint32_t>(i - points);
    const LightPoint<T> point =
        shading.single_sample && area.is_flat
            ? Lights::middle<T>(area)
            : lights.sample<T>(lamps, hits.random(kFirstAreaLight + number));
    const WayToLight<T> way(lights, hits.surface, point.position);
    ask<T>(hits, i, scatters, light_from_area(hits, way, point, light * spread<T>(lamp.area)),
           lamps, point);
  }
}

/// The lanes in which a ray of this weight is worth tracing; counts the others.
template <class T>
RAYGATE_INLINE MaskOf<T> worthwhile(const ShadingScene& shading, const Hits<T>& hits,
                                    const Triple<T>& weight, SkipCounters& skipped) {
  const T size = largest(weight);
  float sizes[Hits<T>::kCount];
  lanes_to(sizes, size);
  for (int k = 0; k < hits.count; ++k) {
    if (sizes[k] == 0.0f) {
      skipped.weightless += shading.skips_weightless ? 1 : 0;
    } else if (sizes[k] < shading.threshold) {
      ++skipped.dim;
    }
  }
  const auto is_bright = (size > 0.0f) & !(size < shading.threshold);
  return shading.skips_weightless ? MaskOf<T>(is_bright) : MaskOf<T>(is_bright | (size == 0.0f));
}

template <class T>
RAYGATE_INLINE void go_on(const ShadingScene& shading, Hits<T>& hits, SkipCounters& skipped) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  WaysOn<T> ways;
  ways.density = T{};
  ways.scattered_at = ways.normal = zero<T>();
  ways.weight = hits.weight * bsdf.mirror();
  Triple<T> facet = surface.normal, through = bsdf.through();
  if (has_rough_facets(hits)) {
    // By chance, as the facets lie (Cook, Porter and Carpenter 1984).
    const FacetLobes<T>& facets = bsdf.facets();
    const auto found = facets.glass_facet(hits.random(kFacet));
    facet = found.normal;
    const T cosine = at_least(dot(surface.view, facet), 0.0f);
    Triple<T> reflected =
        choose(is_narrow(hits), facets.mirrored_by_facet(schlick_share(cosine)), zero<T>());
    if (bsdf.has_rough_glass()) {
      const T mirrored = facets.glass * found.reflectance;
      reflected = reflected + Triple<T>{mirrored, mirrored, mirrored};
      const Refraction<T> bent(surface.view, facet, bsdf.eta());
      through = facets.tint * ((facets.glass - mirrored) * facets.through_share(bent.direction));
    }
    ways.weight = hits.weight * reflected * facets.mirrored_share(mirrored(surface.view, facet));
    // Lamps are asked for what these facets show of them; glass shows them by its rays alone.
    ways.density = choose(facets.is_glass, T{}, spread<T>(1.0f));
  }
  ways.is_wanted = bsdf.mirror_is_traced();
  if (any(ways.is_wanted)) {
    ways.is_wanted = ways.is_wanted & worthwhile(shading, hits, ways.weight, skipped);
  }
  if (any(ways.is_wanted)) {
    ways.direction = mirrored(surface.view, facet);
    ways.flat = mirrored(surface.view, surface.flat_normal);
    ways.has_flat = ways.is_wanted;
    ways.is_through = ways.is_wanted & !ways.is_wanted;
    ways.stream = mixed(hits.stream, kMirror);
    ways.send(hits, 0);
  }
  ways.density = T{};
  ways.weight = hits.weight * through;
  ways.is_wanted = worthwhile(shading, hits, ways.weight, skipped);
  if (any(ways.is_wanted)) {
    const Refraction<T> bent(surface.view, facet, bsdf.eta());
    const Refraction<T> flat(surface.view, surface.flat_normal, bsdf.eta());
    const MaskOf<T>& is_bent = bsdf.is_refracting();
    ways.direction = choose(is_bent, bent.direction, -surface.view);
    ways.flat = choose(is_bent, flat.direction, -surface.view);
    ways.has_flat = (!is_bent) | flat.exists;
    ways.is_wanted = ways.is_wanted & ((!is_bent) | bent.exists);
    ways.is_through = ways.is_wanted;
    ways.stream = mixed(hits.stream, kThrough);
    ways.send(hits, 1);
  }
}

}  // namespace

void Whitted::shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) {
  const ShadingScene& shading = shading_;
  SkipCounters& skipped = skipped_;
  in_lanes(shading, block, kind, at, [&](auto& hits) RAYGATE_BODY {
    using T = std::remove_cvref_t<decltype(hits.density)>;
    const Bsdf<T>& bsdf = hits.bsdf;
    const bool goes_on = block.wave->depth < shading.max_depth;
    Triple<T> emission = bsdf.emission(), glossy = bsdf.glossy();
    // What a lamp was asked for is not counted again where it is met.
    if ((kind & kEmits) != 0) emission = choose(hits.density > 0.0f, zero<T>(), emission);
    if (goes_on && has_rough_facets(hits)) glossy = choose(is_narrow(hits), zero<T>(), glossy);
    const Triple<T> shown =
        emission + bsdf.unlit() + (bsdf.diffuse() + glossy) * spread<T>(shading.ambient);
    Triple<T> background = zero<T>();
    if (any(!bsdf.mirror_is_traced())) {
      const Triple<T> way = mirrored(hits.surface.view, hits.surface.normal);
      background = bsdf.mirror() * sky(shading.lights, way);
    }
    hits.set_radiance(hits.weight *
                      (shown + choose(bsdf.mirror_is_traced(), zero<T>(), background)));
    ask_all_lights(shading, hits);
    if (goes_on) go_on(shading, hits, skipped);
  });
}

}  // namespace raygate
