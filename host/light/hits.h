// Hits that are shaded together, as many as there are lanes: their surfaces and BSDFs, the light
// that they sample, and the rays that they scatter.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/triple.h"
#include "host/intersect/intersector.h"
#include "host/light/bsdf.h"
#include "host/light/integrator_options.h"
#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/ray_batch.h"
#include "host/light/sampler.h"
#include "host/light/spawn_ray.h"
#include "host/light/surface.h"

namespace raygate {

class LightPaths;

/// What one light sends to a hit if nothing is between: a shadow ray to trace.
struct LightSample {
  enum State : std::uint8_t {
    kNone,
    kDark,  ///< nothing would arrive
    kToTrace,
  };
  State state = kNone;
  glm::vec3 radiance{0.0f};               ///< what arrives if nothing is between
  SpawnSide side = SpawnSide::kIncident;  ///< transmitted: by rough glass
  std::uint32_t light_index = 0;          ///< kNoIndex: this goes to the camera's lens
  glm::vec3 point{0.0f};  ///< of an area light; or, without a primitive, the direction to any
                          ///< other; or of the lens
  std::uint32_t primitive = 0;
};

/// A ray that a hit sends on: reflected, refracted or scattered.
struct ScatteredRay {
  bool is_wanted = false;
  bool surely_leaves = false;  ///< the triangle, to that side; or else exact arithmetic decides
  bool has_flat = false;
  SpawnSide side = SpawnSide::kIncident;
  glm::vec3 direction{0.0f};  ///< scaled
  /// Where the direction, made with an interpolated normal, leads to the wrong side: that of the
  /// flat normal.
  glm::vec3 flat{0.0f};
  PathState state;  ///< but for sample and index, which stay
};

/// A part of a batch, its hits, and their results: lists by the ray's place in the part.
struct HitBlock {
  const RayBatch* batch = nullptr;
  std::size_t begin = 0;                             ///< in the batch
  std::vector<SurfaceHit> places;                    ///< no face: nothing is hit
  std::vector<const MaterialParameters*> materials;  ///< of the hits
  std::vector<glm::vec3> radiance;                   ///< along the ray, already weighted
  std::vector<LightSample> light_samples;            ///< `light_samples_per_hit` of each hit
  std::vector<ScatteredRay> scattered;               ///< `scattered_per_hit` of each hit
  std::size_t light_samples_per_hit = 0, scattered_per_hit = 0;
  FirstSurface* first_surfaces = nullptr;  ///< by sample; none after the camera's rays
  SkipCounters skipped;

  [[nodiscard]] const PathState& state(std::size_t i) const { return batch->states[begin + i]; }
  [[nodiscard]] LightSample& light_sample(std::size_t i, std::size_t number) {
    return light_samples[i * light_samples_per_hit + number];
  }
  [[nodiscard]] ScatteredRay& scattered_ray(std::size_t i, std::size_t number) {
    return scattered[i * scattered_per_hit + number];
  }
};

/// What all hits are shaded with. The references must outlive this.
struct ShadingScene {
  const Scene& scene;
  const Bvh& bvh;
  const Lights& lights;
  glm::vec3 ambient{0.0f};  ///< radiance from all sides, before anything is in its way
  int max_depth = 4;
  float threshold = 0.0f;
  bool single_sample = false;
  bool skips_weightless = true;
  PathOptions path{};
  const LightPaths* light_paths = nullptr;  ///< none: camera paths find all light
};

/// The matte colour at which `surface` looks like the background, in the light of all lights
/// from one point to all sides and of `around`, the radiance from all sides: where any of these is
/// kept away it is darker. At most 1. Light of other sources makes it brighter.
template <class T>
RAYGATE_INLINE Triple<T> catcher_colour(const Lights& lights, const glm::vec3& around,
                                        const Surface<T>& surface) {
  constexpr float kPerPi = 0.318309886183790671537767526745f;
  Triple<T> light = spread<T>(around);
  for (std::uint32_t i = 0; i < lights.points().size(); ++i) {
    const Lights::Light& light_record = lights.light(i);
    if (light_record.is_spot) continue;
    const Triple<T> way =
        (spread<T>(light_record.position) - surface.point) * spread<T>(lights.per_unit());
    const T squared = dot(way, way), slope = dot(surface.normal, way);
    // A cosine, over pi and the squared distance.
    const T share = slope * kPerPi / (squared * root(squared));
    light = light + spread<T>(light_record.emission) * choose(slope > 0.0f, share, T{});
  }
  const Triple<T> shown = spread<T>(lights.background());
  const auto ratio = [](const T& wanted, const T& there) {
    return choose(wanted < there, wanted / there, spread<T>(1.0f));
  };
  return {ratio(shown.x, light.x), ratio(shown.y, light.y), ratio(shown.z, light.z)};
}

/// As many hits of one kind as T has lanes.
template <class T>
struct Hits {
  static constexpr int kCount = kLanesOf<T>;

  /// `at` says where in the block; where there are fewer than lanes, the last one fills the rest.
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
    throughput = gather<T>(states, &PathState::throughput);
    pdf = gather<T>(states, &PathState::pdf);
    scattered_at = gather<T>(states, &PathState::scattered_at);
    scattering_normal = gather<T>(states, &PathState::normal);
    stream = gather<T>(states, &PathState::stream);
    index = gather<T>(states, &PathState::index);
    ratio = gather<T>(states, &PathState::ratio);
    vertices = gather<T>(states, &PathState::vertices);
    surface = surface_at<T>(shading.scene, shading.bvh, kind, places);
    if ((kind & kShadowCatcher) != 0) {
      surface.colour = catcher_colour(shading.lights, shading.ambient, surface);
    }
    bsdf = Bsdf<T>(surface, kind, materials);
    if (hits.first_surfaces != nullptr) show_first_surfaces();
  }

  /// The cosine of light from a unit direction; 0 where the surface scatters none of it: from the
  /// other side of the triangle, or, of rough glass, where its two normals do not agree on a side.
  [[nodiscard]] RAYGATE_INLINE T cosine(const Triple<T>& towards) const {
    const T cosine = dot(surface.normal, towards), flat = dot(surface.flat_normal, towards);
    if (!bsdf.has_rough_glass()) return choose(flat > 0.0f, at_least(cosine, 0.0f), T{});
    return choose((flat > 0.0f) == (cosine > 0.0f), absolute(cosine), T{});
  }
  /// What chooses lights: the normal, or 0 where light from both sides counts.
  [[nodiscard]] RAYGATE_INLINE Triple<T> lit_normal() const {
    return bsdf.has_rough_glass() ? zero<T>() : surface.normal;
  }

  /// A point of the rays' own random streams for this purpose.
  [[nodiscard]] RAYGATE_INLINE SquarePoint<T> random(std::uint32_t purpose) const {
    return sobol_point<T>(index, hash(stream, purpose));
  }

  /// The BSDF seen from another direction on the same side, and the normal there.
  struct Seen {
    Bsdf<T> bsdf;
    Triple<T> normal;
  };
  [[nodiscard]] RAYGATE_INLINE Seen seen_from(const Triple<T>& direction) const {
    const Surface<T> seen = surface.seen_from(direction);
    return {Bsdf<T>(seen, kind, materials), seen.normal};
  }

  RAYGATE_INLINE void set_radiance(const Triple<T>& radiance) {
    const auto out = unpack(radiance);
    for (int k = 0; k < count; ++k) block.radiance[place[k]] = out[k];
  }

  HitBlock& block;
  HitKind kind;
  int count;
  std::uint32_t place[kCount];  ///< in the block
  Triple<T> throughput, scattered_at, scattering_normal;
  T pdf, ratio;
  WordOf<T> stream, index, vertices;
  const MaterialParameters* materials[kCount];
  Surface<T> surface;
  Bsdf<T> bsdf;

 private:
  RAYGATE_INLINE void show_first_surfaces() {
    const auto normals = unpack(surface.normal), colours = unpack(surface.colour);
    for (int k = 0; k < count; ++k) {
      block.first_surfaces[block.state(place[k]).sample] = {normals[k], colours[k]};
    }
  }
};

/// Rays that go on where `is_wanted`; `number` says which of their hits' rays they are.
template <class T>
struct ScatteredRays {
  Triple<T> direction, flat, throughput, scattered_at, normal;
  T pdf, ratio = T{};
  WordOf<T> stream, vertices = WordOf<T>{};
  MaskOf<T> is_wanted, has_flat, is_transmitted;

  RAYGATE_INLINE void send(Hits<T>& hits, std::size_t number) const {
    const Triple<T> ahead = scaled(direction);
    const auto leaving = hits.surface.leaving(ahead, is_transmitted);
    const auto wanted = unpack(is_wanted & (leaving.leaves | (!leaving.is_sure) | has_flat));
    const auto sure = unpack(leaving.leaves & leaving.is_sure);
    const auto flats = unpack(has_flat);
    const auto transmitted = unpack(is_transmitted);
    const auto directions = unpack(ahead), flat_ones = unpack(scaled(flat)),
               throughputs = unpack(throughput), points = unpack(scattered_at),
               normals = unpack(normal);
    const auto pdfs = unpack(pdf), ratios = unpack(ratio);
    const auto streams = unpack(stream), counts = unpack(vertices);
    for (int k = 0; k < hits.count; ++k) {
      if (!wanted[k]) continue;
      ScatteredRay& ray = hits.block.scattered_ray(hits.place[k], number);
      ray.is_wanted = true;
      ray.surely_leaves = sure[k];
      ray.has_flat = flats[k];
      ray.side = transmitted[k] ? SpawnSide::kTransmitted : SpawnSide::kIncident;
      ray.direction = directions[k];
      ray.flat = flat_ones[k];
      ray.state.throughput = throughputs[k];
      ray.state.pdf = pdfs[k];
      ray.state.scattered_at = points[k];
      ray.state.normal = normals[k];
      ray.state.stream = streams[k];
      ray.state.ratio = ratios[k];
      ray.state.vertices = counts[k];
    }
  }
};

}  // namespace raygate
