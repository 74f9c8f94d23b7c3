// Whitted's ray tracing: all lights, mirrors and glass; and the emission that the camera sees
// directly, in mirrors and through glass.
#include "host/light/hits.h"

namespace raygate {
namespace {

// Streams of random numbers.
constexpr std::uint32_t kMirror = 1, kTransmission = 2, kRoughFacet = 3, kFirstAreaLight = 16,
                        kFirstPointLight = 1u << 16;
constexpr float kNarrow = 0.25f;  // alpha above which reflections show ambient light only

/// Returns whether rays are spawned for reflections of rough facets.
template <class T>
RAYGATE_INLINE bool has_rough_facets(const Hits<T>& hits) {
  return (~hits.kind & (kMetallicRoughness | kGlossy)) == 0;
}
/// Returns `reflected` if the facets are narrow enough to spawn a ray, or else 0.
template <class T>
RAYGATE_INLINE Triple<T> if_narrow(const Ggx<T>& ggx, const Triple<T>& reflected) {
  return choose(ggx.squared > kNarrow * kNarrow, zero<T>(), reflected);
}

/// Returns the light that arrives at each hit from light `i`.
template <class T>
RAYGATE_INLINE IncidentLight<T> light_of(const ShadingScene& shading, const Hits<T>& hits,
                                         std::uint32_t i) {
  using Kind = Lights::Kind;
  const Lights& lights = shading.lights;
  const Lights::Light& own = lights.light(i);
  const Lights::Light* same[Hits<T>::kCount];
  std::ranges::fill(same, &own);
  IncidentLight<T> light;
  if (own.kind == Kind::kArea) {
    const auto number = static_cast<std::uint32_t>(i - lights.points().size());
    // Avoids the shared edge at a quadrilateral's centre: rays to an edge need exact arithmetic.
    const bool in_middle = shading.settings.samples == 1 && own.patches == 1;
    const SquarePoint<T> centre = {spread<T>(0.5f + 0x1p-11f), spread<T>(0.5f)};
    const LightPoint<T> point =
        lights.sample<T>(own, in_middle ? centre : hits.random(kFirstAreaLight + number));
    const Triple<T> emission =
        in_middle ? spread<T>(own.emission) : lights.radiance_at<T>(same, point);
    light = area_light(lights, hits, point, emission * spread<T>(own.area));
    light.is_asked = hits.bsdf.scatters();
    return light;
  }
  if (own.kind == Kind::kPoint) {
    light = point_light(lights, hits, same, WordOf<T>{} + i, shading.settings.samples == 1,
                        kFirstPointLight + i);
  } else {
    light = IncidentLight<T>(hits, spread<T>(own.position));
    light.emission = spread<T>(own.emission);
  }
  light.is_asked = T{} == 0.0f;
  return light;
}

/// Samples every light at each hit, except the environment, which is the ambient light.
template <class T>
RAYGATE_INLINE void sample_all_lights(const ShadingScene& shading, Hits<T>& hits) {
  using Kind = Lights::Kind;
  for (std::uint32_t i = 0; i < shading.lights.count(); ++i) {
    const Kind kind = shading.lights.light(i).kind;
    const bool is_area = kind == Kind::kArea;
    if (kind == Kind::kEnvironment || (is_area && !any(hits.bsdf.scatters()))) continue;
    const IncidentLight<T> light = light_of(shading, hits, i);
    const Triple<T> scattered = hits.bsdf.eval(light.direction, !light.is_area);
    add_light_sample(hits, i, light, scattered_light(hits, light, scattered, spread<T>(1.0f)));
  }
}

/// Returns the lanes in which a ray of this throughput is worth tracing.
template <class T>
RAYGATE_INLINE MaskOf<T> worthwhile(const ShadingScene& shading, const Triple<T>& throughput) {
  const T size = largest(throughput);
  return (size > 0.0f) & !(size < static_cast<float>(shading.settings.threshold));
}

/// Spawns reflected and transmitted rays. Without `goes_on` the maximum depth is reached, and rays
/// only continue through holes of masks.
template <class T>
RAYGATE_INLINE void spawn_specular_rays(const ShadingScene& shading, Hits<T>& hits, bool goes_on) {
  const Surface<T>& surface = hits.surface;
  const Bsdf<T>& bsdf = hits.bsdf;
  ScatteredRays<T> next(hits);
  next.path.pdf = T{};
  next.path.scattered_at = next.path.normal = zero<T>();
  next.path.throughput = hits.path.throughput * bsdf.mirror;
  Triple<T> facet = surface.normal, transmitted = bsdf.transmission;
  if (has_rough_facets(hits)) {
    // A random facet (Cook, Porter and Carpenter 1984).
    const MetallicRoughnessLobes<T>& facets = bsdf.facets;
    facet = facets.ggx.sample(surface.view, hits.random(kRoughFacet));
    const T cosine = at_most(at_least(dot(surface.view, facet), 0.0f), 1.0f);
    Triple<T> reflected = if_narrow(facets.ggx, facets.schlick(schlick_weight(cosine)));
    if (bsdf.has_rough_glass()) {
      const T glass = facets.glass * facets.glass_gain,
              mirrored = glass * fresnel_reflectance(cosine, facets.eta);
      reflected = reflected + facets.grey(mirrored);
      const Refraction<T> bent(surface.view, facet, bsdf.eta);
      transmitted = facets.tint * ((glass - mirrored) * facets.g1(bent.direction));
    }
    reflected = reflected * facets.g2_over_g1(reflect(surface.view, facet));
    next.path.throughput = hits.path.throughput * reflected;
    // Marks the ray: lights are sampled for these facets, so the ray's hit adds no emission.
    next.path.pdf = spread<T>(1.0f);
  }
  next.is_wanted = T{} > 0.0f;
  if (goes_on) next.is_wanted = worthwhile(shading, next.path.throughput);
  if (any(next.is_wanted)) {
    next.reflect_off(hits, facet);
    next.path.stream = hash(hits.path.stream, kMirror);
    next.send(hits, 0);
  }
  if (!bsdf.has_rough_glass()) next.path.pdf = T{};
  next.path.throughput = hits.path.throughput * transmitted;
  next.is_wanted = worthwhile(shading, next.path.throughput);
  if (!goes_on) {
    const T least = minimum(minimum(transmitted.x, transmitted.y), transmitted.z);
    next.is_wanted = next.is_wanted & !bsdf.is_refracting & !(least < 1.0f);
  }
  if (any(next.is_wanted)) {
    const MaskOf<T> is_way = next.pass_through(hits, facet);
    next.is_wanted = next.is_wanted & is_way;
    next.path.stream = hash(hits.path.stream, kTransmission);
    next.send(hits, 1);
  }
}

/// Spawns the rays whose histories are in PathState::supersampled: reflected, refracted, and
/// straight through holes and clear surfaces. Going straight does not change the history.
template <class T>
RAYGATE_INLINE void spawn_specular_rays(Hits<T>& hits) {
  const Bsdf<T>& bsdf = hits.bsdf;
  const Triple<T>& normal = hits.surface.normal;
  ScatteredRays<T> next(hits);
  const WordOf<T> first = hits.path.sample - hits.path.specular_history;
  const auto send = [&](std::size_t number, const Triple<T>& share,
                        const MaskOf<T>& is_way) RAYGATE_BODY {
    next.path.sample = first + next.path.specular_history;
    next.path.throughput = hits.path.throughput * share;
    const auto is_asked = PathLanes<T>::has(hits.path.supersampled, next.path.specular_history);
    next.is_wanted = is_way & is_asked & (next.path.specular_history > 0u) &
                     (largest(next.path.throughput) > 0.0f);
    next.send(hits, number);
  };
  if ((hits.kind & kMirrors) != 0) {
    next.reflect_off(hits, normal);
    send(0, bsdf.mirror, T{} == 0.0f);
  }
  if ((hits.kind & kTransmits) != 0) {
    const MaskOf<T> is_way = next.pass_through(hits, normal);
    send(1, bsdf.transmission, is_way);
  }
}

}  // namespace

void shade_whitted(const ShadingScene& shading, HitBlock& block, HitKind kind,
                   std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&]<class T>(Hits<T>& hits) RAYGATE_BODY {
    const Bsdf<T>& bsdf = hits.bsdf;
    const bool goes_on = block.batch->depth < shading.max_depth;
    Triple<T> emission = hits.emission(), glossy = bsdf.glossy;
    // Emission is omitted if lights were sampled at the previous hit.
    if ((kind & kEmits) != 0) emission = choose(hits.path.pdf > 0.0f, zero<T>(), emission);
    if (goes_on && has_rough_facets(hits)) {
      const MetallicRoughnessLobes<T>& facets = bsdf.facets;
      glossy = facets.specular - if_narrow(facets.ggx, facets.specular);
    }
    const Triple<T> shown =
        emission + bsdf.unlit + (bsdf.diffuse + glossy) * spread<T>(shading.ambient);
    hits.set_radiance(hits.path.throughput * shown);
    sample_all_lights(shading, hits);
    if (goes_on || (kind & kTransmits) != 0) spawn_specular_rays(shading, hits, goes_on);
  });
}

void shade_emitters(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at) {
  shade_in_lanes(shading, block, kind, at, [&]<class T>(Hits<T>& hits) RAYGATE_BODY {
    Triple<T> emitted = zero<T>();
    if ((kind & kEmits) != 0) {
      emitted = choose(hits.are_supersampled(), hits.path.throughput * hits.bsdf.emission, emitted);
    }
    hits.set_radiance(emitted);
    if (block.batch->depth > shading.max_depth || hits.bsdf.has_rough_glass()) return;
    spawn_specular_rays(hits);
  });
}

}  // namespace raygate
