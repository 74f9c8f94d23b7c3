// Hits that are shaded together, one per lane: their surfaces and BSDFs, light samples and
// scattered rays; and the shading functions of the integrators.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <iterator>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "host/base/vectors.h"
#include "host/intersect/intersector.h"
#include "host/light/bsdf.h"
#include "host/light/integrator_settings.h"
#include "host/light/lights.h"
#include "host/light/ray_batch.h"
#include "host/light/spawn_ray.h"

namespace raygate {

class LightPaths;

/// A ray spawned at a hit: reflected, refracted or scattered. Directions are scaled (is_scaled).
struct alignas(16) ScatteredRay {
  PathState state;
  glm::vec3 direction{0.0f};  ///< scaled
  /// Direction made with the geometric normal, used if `direction` leads to the wrong side.
  glm::vec3 flat{0.0f};
  std::uint32_t is_wanted : 1 = 0;
  /// The ray certainly leaves to the right side; if unset, exact arithmetic decides.
  std::uint32_t surely_leaves : 1 = 0;
  std::uint32_t has_flat : 1 = 0, is_transmitted : 1 = 0;

  [[nodiscard]] SpawnSide side() const {
    return is_transmitted != 0 ? SpawnSide::kTransmitted : SpawnSide::kIncident;
  }
};

/// Packs masks into the flags of a ScatteredRay or LightSample: bit k is mask k.
template <class T, class... Masks>
RAYGATE_INLINE T flag_words(const Masks&... masks) {
  WordOf<T> flags{};
  std::uint32_t bit = 1;
  ((flags |= choose(masks, spread<WordOf<T>>(bit), WordOf<T>{}), bit <<= 1), ...);
  return float_of(flags);
}

/// Path states, field by field, one path per lane.
template <class T>
struct PathLanes {
  Triple<T> throughput;
  T pdf;
  Triple<T> scattered_at, normal;
  WordOf<T> sample, stream, index, specular_history;
  T light_over_camera_pdf;
  WordOf<T> supersampled;

  PathLanes() = default;
  RAYGATE_INLINE explicit PathLanes(const PathState* const (&states)[kLanesOf<T>]) {
    T words[16];
    load_records(states, words);
    const T* word = words;
    for_each_word(*this, [&](auto& member) RAYGATE_BODY {
      member = __builtin_bit_cast(std::remove_reference_t<decltype(member)>, *word++);
    });
  }
  /// Returns whether each ray is the first of its path.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> is_first() const { return specular_history == 1u; }
  /// Return specular_history after reflection in a mirror and after refraction by glass.
  [[nodiscard]] RAYGATE_INLINE WordOf<T> after_mirror() const { return after_specular(0); }
  [[nodiscard]] RAYGATE_INLINE WordOf<T> after_glass() const { return after_specular(1); }
  /// Returns whether bit `history` of `mask` is set. Histories are below kSpecularHistories.
  [[nodiscard]] RAYGATE_INLINE static MaskOf<T> has(const WordOf<T>& mask,
                                                    const WordOf<T>& history) {
    return ((mask >> (history & (kSpecularHistories - 1))) & 1u) != 0u;
  }
  /// Stores the 16 words of PathState, one path per lane.
  RAYGATE_INLINE void put(T* word) const {
    for_each_word(*this, [&](const auto& member) RAYGATE_BODY { *word++ = float_of(member); });
  }

 private:
  /// Calls visit(member) for each word of PathState, in its order.
  template <class Lanes, class Visit>
  RAYGATE_INLINE static void for_each_word(Lanes& p, const Visit& visit) {
    static_assert(offsetof(PathState, scattered_at) == 16 && offsetof(PathState, sample) == 40 &&
                  offsetof(PathState, light_over_camera_pdf) == 56 && sizeof(PathState) == 64);
    const auto visit_all = [&](auto&... members) RAYGATE_BODY { (visit(members), ...); };
    visit_all(p.throughput.x, p.throughput.y, p.throughput.z, p.pdf, p.scattered_at.x,
              p.scattered_at.y, p.scattered_at.z, p.normal.x, p.normal.y, p.normal.z, p.sample,
              p.stream, p.index, p.specular_history, p.light_over_camera_pdf, p.supersampled);
  }
  [[nodiscard]] RAYGATE_INLINE WordOf<T> after_specular(std::uint32_t step) const {
    const auto has_next = (specular_history > 0u) & (specular_history < kSpecularHistories / 2);
    return choose(has_next, 2u * specular_history + step, WordOf<T>{});
  }
};

/// A part of a batch with its hits and results. Lists are indexed by a ray's position in the part.
struct HitBlock {
  const RayBatch* batch = nullptr;
  std::size_t begin = 0;                             ///< index in the batch of the part's first ray
  std::vector<SurfaceHit> places;                    ///< of the hits
  std::vector<const MaterialParameters*> materials;  ///< of the hits
  std::vector<glm::vec3> radiance;                   ///< along the ray, times the path's throughput
  std::vector<LightSample> light_samples;            ///< `light_samples_per_hit` for each hit
  std::vector<ScatteredRay> scattered;               ///< `scattered_per_hit` for each hit
  std::size_t light_samples_per_hit = 0, scattered_per_hit = 0;
  /// FirstSurface, by position; null unless the hit is its path's first. Empty if all are null.
  std::vector<FirstSurface*> first_surfaces;

  [[nodiscard]] const PathState& state(std::size_t i) const { return batch->states[begin + i]; }
  [[nodiscard]] std::span<LightSample> light_samples_of(std::size_t i) {
    return std::span(light_samples).subspan(i * light_samples_per_hit, light_samples_per_hit);
  }
  [[nodiscard]] std::span<ScatteredRay> scattered_of(std::size_t i) {
    return std::span(scattered).subspan(i * scattered_per_hit, scattered_per_hit);
  }
};

/// Data shared by the shading of all hits. The references must outlive this object.
struct ShadingScene {
  const Scene& scene;
  const Bvh& bvh;
  const Lights& lights;
  const IntegratorSettings& settings;
  glm::vec3 ambient{0.0f};                  ///< radiance from all sides, before occlusion
  int max_depth = 4;                        ///< maximum depth of rays
  const LightPaths* light_paths = nullptr;  ///< null: camera paths find all light
};

/// Returns the diffuse colour, at most 1, with which `surface` looks like the background when lit
/// by all point lights without a cone and by the uniform radiance `around`.
template <class T>
RAYGATE_INLINE Triple<T> catcher_colour(const Lights& lights, const glm::vec3& around,
                                        const Surface<T>& surface) {
  Triple<T> light = spread<T>(around);
  for (std::uint32_t i = 0; i < lights.points().size(); ++i) {
    const Lights::Light& light_record = lights.light(i);
    if (light_record.is_spot) continue;
    const Triple<T> way =
        (spread<T>(light_record.position) - surface.point) * spread<T>(lights.per_unit());
    const T squared = dot(way, way), slope = dot(surface.normal, way);
    // cosine / (pi distance^2)
    const T share = slope * kPerPi / (squared * root(squared));
    light = light + spread<T>(light_record.emission) * choose(slope > 0.0f, share, T{});
  }
  const Triple<T> shown = spread<T>(lights.background());
  const auto ratio = [](const T& wanted, const T& there) {
    return choose(wanted < there, wanted / there, spread<T>(1.0f));
  };
  return {ratio(shown.x, light.x), ratio(shown.y, light.y), ratio(shown.z, light.z)};
}

/// Hits of one kind, one per lane of T.
template <class T>
struct Hits {
  static constexpr int kCount = kLanesOf<T>;

  /// `at`: positions in the block; if there are fewer than lanes, the last position is repeated.
  RAYGATE_INLINE Hits(const ShadingScene& shading, HitBlock& hits, HitKind hit_kind,
                      std::span<const std::uint32_t> at)
      : block(hits), kind(hit_kind), count(static_cast<int>(at.size())) {
    const PathState* states[kCount];
    SurfaceHit places[kCount];
    for (int k = 0; k < kCount; ++k) {
      place[k] = at[static_cast<std::size_t>(k < count ? k : count - 1)];
      states[k] = &hits.state(place[k]);
      places[k] = hits.places[place[k]];
      materials[k] = hits.materials[place[k]];
    }
    path = PathLanes<T>(states);
    surface = surface_at<T>(shading.scene, shading.bvh, kind, places);
    if ((kind & kShadowCatcher) != 0) {
      surface.colour = catcher_colour(shading.lights, shading.ambient, surface);
    }
    bsdf = Bsdf<T>(surface, kind, materials);
    if (!hits.first_surfaces.empty()) show_first_surfaces();
  }

  /// Returns the cosine (rough glass: its magnitude) of a unit direction to the shading normal. 0
  /// if its light is not scattered: from behind the triangle; for rough glass, if it is on one side
  /// by the shading normal and on the other by flat_normal.
  [[nodiscard]] RAYGATE_INLINE T cosine(const Triple<T>& towards) const {
    const T cosine = dot(surface.normal, towards), flat = dot(surface.flat_normal, towards);
    if (!bsdf.has_rough_glass()) return choose(flat > 0.0f, at_least(cosine, 0.0f), T{});
    return choose((flat > 0.0f) == (cosine > 0.0f), absolute(cosine), T{});
  }
  /// Returns the shading normal for sampling lights, or 0 if light from both sides counts.
  [[nodiscard]] RAYGATE_INLINE Triple<T> lit_normal() const {
    return bsdf.has_rough_glass() ? zero<T>() : surface.normal;
  }

  /// Returns whether EmitterSupersampler adds the emission of the hit.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> are_supersampled() const {
    const auto are_even = gather<T>(materials, &MaterialParameters::emits_evenly);
    const auto are_wanted = PathLanes<T>::has(path.supersampled, path.specular_history);
    return are_even & are_wanted;
  }
  /// Returns the emission, or 0 where EmitterSupersampler adds it.
  [[nodiscard]] RAYGATE_INLINE Triple<T> emission() const {
    if ((kind & kEmits) == 0) return bsdf.emission;
    return choose(are_supersampled(), zero<T>(), bsdf.emission);
  }

  /// Returns a random point of the unit square for the path. Each purpose has its own stream.
  [[nodiscard]] RAYGATE_INLINE SquarePoint<T> random(std::uint32_t purpose) const {
    return random_point<T>(path.index, path.stream, purpose);
  }

  /// The BSDF and shading normal as seen from another direction on the same side.
  struct Seen {
    Bsdf<T> bsdf;
    Triple<T> normal;
  };
  [[nodiscard]] RAYGATE_INLINE Seen seen_from(const Triple<T>& direction) const {
    const Surface<T> seen = surface.seen_from(direction);
    return {bsdf.seen_from(seen, materials), seen.normal};
  }

  RAYGATE_INLINE void set_radiance(const Triple<T>& radiance) {
    const auto out = unpack(radiance);
    for (int k = 0; k < count; ++k) block.radiance[place[k]] = out[k];
  }

  HitBlock& block;
  HitKind kind;
  int count;
  std::uint32_t place[kCount];  ///< in the block
  PathLanes<T> path;
  const MaterialParameters* materials[kCount];
  Surface<T> surface;
  Bsdf<T> bsdf;

 private:
  RAYGATE_INLINE void show_first_surfaces() {
    const auto normals = unpack(surface.normal), colours = unpack(surface.colour);
    for (int k = 0; k < count; ++k) {
      FirstSurface* const first = block.first_surfaces[place[k]];
      if (first == nullptr) continue;
      first->normal = normals[k];
      first->albedo = colours[k];
    }
  }
};

/// Rays spawned at hits, in the lanes in which `is_wanted` is set.
template <class T>
struct ScatteredRays {
  PathLanes<T> path;
  Triple<T> direction, flat;
  MaskOf<T> is_wanted, has_flat, is_transmitted;

  RAYGATE_INLINE explicit ScatteredRays(const Hits<T>& hits) : path(hits.path) {}

  /// Sets `direction` to the view reflected about `normal`; `flat`, about the geometric normal.
  RAYGATE_INLINE void reflect_off(const Hits<T>& hits, const Triple<T>& normal) {
    direction = reflect(hits.surface.view, normal);
    flat = reflect(hits.surface.view, hits.surface.flat_normal);
    has_flat = T{} == 0.0f;
    is_transmitted = !has_flat;
    path.specular_history = hits.path.after_mirror();
  }
  /// Sets the directions to those through the surface: refracted at `normal` if the material
  /// refracts, otherwise straight on. Returns in which lanes such a direction exists.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> pass_through(const Hits<T>& hits,
                                                      const Triple<T>& normal) {
    const Surface<T>& surface = hits.surface;
    const MaskOf<T>& is_bent = hits.bsdf.is_refracting;
    const Refraction<T> bent(surface.view, normal, hits.bsdf.eta);
    const Refraction<T> flat_bent(surface.view, surface.flat_normal, hits.bsdf.eta);
    direction = choose(is_bent, bent.direction, -surface.view);
    flat = choose(is_bent, flat_bent.direction, -surface.view);
    has_flat = (!is_bent) | flat_bent.exists;
    is_transmitted = T{} == 0.0f;
    path.specular_history = choose(is_bent, hits.path.after_glass(), hits.path.specular_history);
    return (!is_bent) | bent.exists;
  }

  RAYGATE_INLINE void send(Hits<T>& hits, std::size_t number) const {
    const Triple<T> ahead = scaled(direction), aside = scaled(flat);
    const typename Surface<T>::Slope slope(hits.surface, ahead);
    const auto leaves = hits.surface.leaves(slope, is_transmitted);
    const auto wanted = is_wanted & (leaves | (!slope.is_sure) | has_flat);
    static_assert(offsetof(ScatteredRay, direction) == 64 && sizeof(ScatteredRay) == 96);
    const T flags = flag_words<T>(wanted, leaves & slope.is_sure, has_flat, is_transmitted);
    const T rest[] = {ahead.x, ahead.y, ahead.z, aside.x, aside.y, aside.z, flags};
    T words[24] = {};
    path.put(words);
    std::copy(std::begin(rest), std::end(rest), words + 16);
    ScatteredRay* rays[Hits<T>::kCount];
    for (int k = 0; k < hits.count; ++k) rays[k] = &hits.block.scattered_of(hits.place[k])[number];
    store_records(words, rays, hits.count);
  }
};

/// Calls shade(hits) for the hits at positions `at` of the block, as many at a time as there are
/// lanes. Baseline code has one lane; any number of lanes gives the same bits.
template <class Shade>
void shade_in_lanes(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at, const Shade& shade) {
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = kLanesOf<T>;
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      Hits<T> hits(shading, block, kind, at.subspan(i, std::min(kCount, at.size() - i)));
      shade(hits);
    }
  });
}

/// Shades the hits at positions `at` of the block, all of one kind.
using ShadeFunction = void(const ShadingScene& shading, HitBlock& block, HitKind kind,
                           std::span<const std::uint32_t> at);

/// Whitted's ray tracing ("An improved illumination model for shaded display", 1980). Adds, at each
/// hit, emission, an ambient term for interreflection, and direct light, with a shadow ray to each
/// point light and to one point of each area light. Spawns rays through mirrors and glass, up to
/// the maximum depth or until their throughput is below the threshold. With one sample per pixel, a
/// light that is one triangle or parallelogram is sampled at its centre.
ShadeFunction shade_whitted;

/// Path tracing (Kajiya, "The rendering equation", 1986). At each hit one light is sampled and one
/// ray is spawned. Light that both techniques can find is weighted by multiple importance sampling
/// (the power heuristic of Veach and Guibas, 1995). Russian roulette begins after three surfaces.
/// The last rays, one deeper than the maximum depth, add emission only.
ShadeFunction shade_path;

/// Light tracing (Dutre, Lafortune and Willems, "Monte Carlo light tracing with direct computation
/// of pixel intensities", 1993): each hit except a path's first, on a mirror or glass, is connected
/// to the camera by a light sample whose target is on the lens. Each hit spawns one ray.
ShadeFunction shade_light_path;

/// Shades hits on specular paths from the camera whose histories are in PathState::supersampled:
/// adds emission, and spawns reflected and refracted rays. PathState::sample is a multiple of
/// kSpecularHistories plus the history, so each history has its own radiance.
ShadeFunction shade_emitters;

/// Returns a finite number: infinity becomes the largest float, NaN becomes 0.
template <class T>
RAYGATE_INLINE T bounded(const T& x) {
  const T most = spread<T>(std::numeric_limits<float>::max());
  return choose(x < most, x, choose(x == x, most, T{}));
}
template <class T>
RAYGATE_INLINE Triple<T> bounded(const Triple<T>& x) {
  return {bounded(x.x), bounded(x.y), bounded(x.z)};
}

/// Unoccluded light that arrives at each hit from a point or a direction.
template <class T>
struct IncidentLight {
  MaskOf<T> is_asked = T{} > 0.0f;       ///< whether the hit samples this light
  MaskOf<T> is_area = is_asked;          ///< from an area light
  MaskOf<T> is_point_light = is_asked;   ///< from a point light
  Triple<T> direction = zero<T>();       ///< unit vector towards the light
  T distance_squared = spread<T>(1.0f);  ///< in square units; 1: a distant light
  T cosine = T{};                        ///< Hits::cosine of the direction; 0: no light arrives
  T light_cosine = T{};                  ///< of the direction to an area light's normal
  Triple<T> emission = zero<T>();        ///< radiance, intensity or irradiance
  /// Probability of choosing the light times the pdf of its point (per area) or direction.
  T pdf = spread<T>(1.0f);
  Triple<T> target = zero<T>();  ///< target and index as in LightSample
  WordOf<T> index = WordOf<T>{} + NearestHit::kNone;

  IncidentLight() = default;
  /// Sets those fields of light from a point that depend only on its position.
  RAYGATE_INLINE IncidentLight(const Lights& lights, const Hits<T>& hits, const Triple<T>& position)
      : target(position) {
    constexpr float kNear = 1e-30f;  // least distance_squared with light
    const Triple<T> way = (position - hits.surface.point) * spread<T>(lights.per_unit());
    distance_squared = dot(way, way);
    direction = way * (1.0f / root(distance_squared));
    cosine = choose(distance_squared > kNear, hits.cosine(direction), T{});
  }
  /// Sets those fields of a distant light that depend only on the unit vector `towards` it.
  RAYGATE_INLINE IncidentLight(const Hits<T>& hits, const Triple<T>& towards)
      : direction(towards), cosine(hits.cosine(towards)), target(towards) {}

  /// Copies the lanes of `other` in which other.is_asked is set.
  RAYGATE_INLINE void take(const IncidentLight& other) {
    const auto put = [&](auto& own, const auto& others)
                         RAYGATE_BODY { own = choose(other.is_asked, others, own); };
    put(is_area, other.is_area);
    put(is_point_light, other.is_point_light);
    put(direction, other.direction);
    put(distance_squared, other.distance_squared);
    put(cosine, other.cosine);
    put(light_cosine, other.light_cosine);
    put(emission, other.emission);
    put(pdf, other.pdf);
    put(target, other.target);
    put(index, other.index);
    is_asked = is_asked | other.is_asked;
  }
};

/// Returns the light from the point lights `own`, one per lane; `indices` are theirs. A light with
/// a radius is sampled at a random point of its sphere, or at the centre if `in_middle`.
template <class T>
RAYGATE_INLINE IncidentLight<T> point_light(const Lights& lights, const Hits<T>& hits,
                                            const Lights::Light* const (&own)[kLanesOf<T>],
                                            const WordOf<T>& indices, bool in_middle,
                                            std::uint32_t random_purpose) {
  using Light = Lights::Light;
  const Triple<T> middle = gather<T>(own, &Light::position);
  const T radius = gather<T>(own, &Light::radius);
  const bool is_random = !in_middle && any(radius > 0.0f);
  const Triple<T> position = is_random ? Lights::point_on<T>(middle, radius, hits.surface.point,
                                                             hits.random(random_purpose))
                                       : middle;
  IncidentLight<T> light(lights, hits, position);
  light.emission = gather<T>(own, &Light::emission);
  if (any(gather<T>(own, &Light::is_spot))) {
    const T cosine =
        -dot(IncidentLight<T>(lights, hits, middle).direction, gather<T>(own, &Light::spot_axis));
    light.emission = light.emission * spot_falloff(cosine, gather<T>(own, &Light::spot_scale),
                                                   gather<T>(own, &Light::spot_offset));
  }
  light.target = position - hits.surface.point;
  light.is_point_light = !(radius > 0.0f);
  light.index = choose(light.is_point_light, indices, light.index);
  return light;
}

/// Returns the light from points of area lights that were sampled uniformly in area.
template <class T>
RAYGATE_INLINE IncidentLight<T> area_light(const Lights& lights, const Hits<T>& hits,
                                           const LightPoint<T>& point, const Triple<T>& radiance) {
  IncidentLight<T> light(lights, hits, point.position);
  light.is_area = T{} == 0.0f;
  light.light_cosine = absolute(dot(point.normal, light.direction));
  light.emission = radiance;
  light.index = point.primitive;
  return light;
}

/// Returns throughput times the radiance scattered back along the ray; `scattered`: BSDF value.
template <class T>
RAYGATE_INLINE Triple<T> scattered_light(const Hits<T>& hits, const IncidentLight<T>& light,
                                         const Triple<T>& scattered, const T& mis_weight) {
  const Triple<T>& throughput = hits.path.throughput;
  Triple<T> sent = throughput * (scattered * mis_weight) * light.emission *
                   (light.cosine / (light.distance_squared * light.pdf));
  if (any(light.is_area)) {
    const T cosines = light.cosine * light.light_cosine;
    sent = choose(light.is_area,
                  throughput * scattered * (cosines / light.distance_squared) *
                      (light.emission * (mis_weight / light.pdf)),
                  sent);
  }
  return choose(light.cosine > 0.0f, bounded(sent), zero<T>());
}

/// Stores light sample `number` of each hit. The sample contributes `sent` if it is not occluded.
template <class T>
RAYGATE_INLINE void add_light_sample(Hits<T>& hits, std::size_t number,
                                     const IncidentLight<T>& light, const Triple<T>& sent,
                                     bool is_to_camera = false) {
  static_assert(sizeof(LightSample) == 32);
  const auto none = T{} > 0.0f;
  const auto is_asked = light.is_asked & !((sent.x == 0.0f) & (sent.y == 0.0f) & (sent.z == 0.0f));
  const auto is_behind = hits.bsdf.has_rough_glass()
                             ? MaskOf<T>(dot(hits.surface.flat_normal, light.direction) < 0.0f)
                             : none;
  const T index = float_of(light.index);
  const T flags =
      flag_words<T>(is_asked, is_behind, light.is_point_light, is_to_camera ? !none : none);
  const Triple<T>& target = light.target;
  const T words[] = {sent.x, sent.y, sent.z, target.x, target.y, target.z, index, flags};
  LightSample* samples[Hits<T>::kCount];
  for (int k = 0; k < hits.count; ++k)
    samples[k] = &hits.block.light_samples_of(hits.place[k])[number];
  store_records(words, samples, hits.count);
}

/// Returns a^2 / (a^2 + b^2); a may be infinite.
template <class T>
RAYGATE_INLINE T power_heuristic(const T& a, const T& b) {
  const T over = b / a;
  return 1.0f / (1.0f + over * over);
}

}  // namespace raygate
