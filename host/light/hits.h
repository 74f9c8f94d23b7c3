// Hits that are shaded together: what goes into lanes, and what comes out of them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/lane_math.h"
#include "host/intersect/intersector.h"
#include "host/light/bsdf.h"
#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/path_options.h"
#include "host/light/ray_batch.h"
#include "host/light/sampler.h"
#include "host/light/shadow_catcher.h"
#include "host/light/spawn_ray.h"
#include "host/light/surface.h"

namespace raygate {

/// The light that one light may send to a hit, if nothing is between: a shadow ray to trace.
struct LightSample {
  enum State : std::uint8_t {
    kNone,
    kDark,  ///< nothing would arrive
    kToTrace,
  };
  State state = kNone;
  glm::vec3 radiance{0.0f};  ///< what arrives if nothing is between
  std::uint32_t light_index = 0;
  glm::vec3 point{0.0f};  ///< of an area light
  std::uint32_t primitive = 0;
};

/// A ray that may go on.
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

/// A part of a batch, its hits, and what they give: lists by the ray's place in the part.
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
  bool sees_environment = true;      ///< rays that hit nothing
  bool samples_environment = false;  ///< surfaces, as they do lights
  PathOptions path{};
};

/// As many hits of one kind as T has lanes.
template <class T>
struct Hits {
  static constexpr int kCount = LanesOf<T>::kCount;

  /// `at` says where in the block; where there are fewer than lanes, the last one fills the rest.
  RAYGATE_INLINE Hits(const ShadingScene& shading, HitBlock& hits, HitKind hit_kind,
                      std::span<const std::uint32_t> at)
      : block(hits), kind(hit_kind), count(static_cast<int>(at.size())) {
    enum : std::uint8_t { kThroughput, kPdf = 3, kScatteredAt = 4, kNormal = 7, kFields = 10 };
    Gathered<T, kFields> in;
    Gathered<T, 2, std::uint32_t> words;
    SurfaceHit places[kCount];
    const MaterialParameters* materials[kCount];
    for (int k = 0; k < kCount; ++k) {
      place[k] = at[static_cast<std::size_t>(k < count ? k : count - 1)];
      const PathState& state = hits.state(place[k]);
      in.put(kThroughput, k, state.throughput);
      in.values[kPdf][k] = state.pdf;
      in.put(kScatteredAt, k, state.scattered_at);
      in.put(kNormal, k, state.normal);
      words.values[0][k] = state.stream;
      words.values[1][k] = state.index;
      places[k] = hits.places[place[k]];
      materials[k] = hits.materials[place[k]];
    }
    throughput = in.triple(kThroughput);
    pdf = in.one(kPdf);
    scattered_at = in.triple(kScatteredAt);
    scattering_normal = in.triple(kNormal);
    stream = words.one(0);
    index = words.one(1);
    surface = surface_at<T>(shading.scene, shading.bvh, kind, places);
    if ((kind & kShadowCatcher) != 0) {
      surface.colour = catcher_colour(shading.lights, shading.ambient, surface);
    }
    bsdf = Bsdf<T>(surface, kind, materials);
    if (hits.first_surfaces != nullptr) show_first_surfaces();
  }

  /// A point of the rays' own random streams for this purpose.
  [[nodiscard]] RAYGATE_INLINE SquarePoint<T> random(std::uint32_t purpose) const {
    return sobol_point<T>(index, hash(stream, purpose));
  }

  RAYGATE_INLINE void set_radiance(const Triple<T>& radiance) {
    Gathered<T, 3> out = spread_out(radiance);
    for (int k = 0; k < count; ++k) block.radiance[place[k]] = triple_of(out, k);
  }

  HitBlock& block;
  HitKind kind;
  int count;
  std::uint32_t place[kCount];  ///< in the block
  Triple<T> throughput, scattered_at, scattering_normal;
  T pdf;
  WordOf<T> stream, index;
  Surface<T> surface;
  Bsdf<T> bsdf;

  /// Lanes of a triple, to be read one by one.
  [[nodiscard]] RAYGATE_INLINE static Gathered<T, 3> spread_out(const Triple<T>& triple) {
    Gathered<T, 3> out;
    lanes_to(out.values[0], triple.x);
    lanes_to(out.values[1], triple.y);
    lanes_to(out.values[2], triple.z);
    return out;
  }
  [[nodiscard]] RAYGATE_INLINE static glm::vec3 triple_of(const Gathered<T, 3>& lanes, int k) {
    return {lanes.values[0][k], lanes.values[1][k], lanes.values[2][k]};
  }
  /// Lanes of a mask, to be read one by one: 1 or 0.
  [[nodiscard]] RAYGATE_INLINE static Gathered<T, 1> spread_out(const MaskOf<T>& mask) {
    Gathered<T, 1> out;
    lanes_to(out.values[0], choose(mask, spread<T>(1.0f), T{}));
    return out;
  }

 private:
  RAYGATE_INLINE void show_first_surfaces() {
    const Gathered<T, 3> normals = spread_out(surface.normal), colours = spread_out(surface.colour);
    for (int k = 0; k < count; ++k) {
      block.first_surfaces[block.state(place[k]).sample] = {triple_of(normals, k),
                                                            triple_of(colours, k)};
    }
  }
};

/// What is neither infinite nor no number: those come of products of what is too bright and what is
/// nothing, and are as bright as can be, or nothing.
template <class T>
RAYGATE_INLINE T bounded(const T& x) {
  const T most = spread<T>(std::numeric_limits<float>::max());
  return choose(x < most, x, choose(x == x, most, T{}));
}
template <class T>
RAYGATE_INLINE Triple<T> bounded(const Triple<T>& x) {
  return {bounded(x.x), bounded(x.y), bounded(x.z)};
}

/// The way from surfaces to places, in the units of Lights.
template <class T>
struct DirectionToLight {
  Triple<T> direction;  ///< unit vector
  T distance_squared, distance;
  MaskOf<T> is_in_front;  ///< it leads away from the surface, and somewhere

  RAYGATE_INLINE DirectionToLight(const Lights& lights, const Surface<T>& surface,
                                  const Triple<T>& place) {
    constexpr float kNear = 1e-30f;  // floats have room for the inverse
    const Triple<T> way = (place - surface.point) * spread<T>(lights.per_unit());
    distance_squared = dot(way, way);
    distance = root(distance_squared);
    direction = way * (1.0f / distance);
    is_in_front = (distance_squared > kNear) & (dot(surface.flat_normal, direction) > 0.0f);
  }
};

/// Asks for light that is `light` where nothing is between; `number` says which of its hit's
/// samples it is.
template <class T>
RAYGATE_INLINE void add_light_sample(Hits<T>& hits, std::size_t number, const MaskOf<T>& is_asked,
                                     const Triple<T>& light,
                                     const std::uint32_t (&indices)[LanesOf<T>::kCount],
                                     const LightPoint<T>& point) {
  const Gathered<T, 1> asked = Hits<T>::spread_out(is_asked);
  const Gathered<T, 3> lights = Hits<T>::spread_out(light);
  const Gathered<T, 3> places = Hits<T>::spread_out(point.position);
  std::uint32_t primitives[LanesOf<T>::kCount];
  lanes_to(primitives, point.primitive);
  for (int k = 0; k < hits.count; ++k) {
    if (asked.values[0][k] == 0.0f) continue;
    LightSample& light_sample = hits.block.light_sample(hits.place[k], number);
    light_sample.radiance = Hits<T>::triple_of(lights, k);
    const bool is_dark = light_sample.radiance == glm::vec3(0.0f);
    light_sample.state = is_dark ? LightSample::kDark : LightSample::kToTrace;
    light_sample.light_index = indices[k];
    light_sample.point = Hits<T>::triple_of(places, k);
    light_sample.primitive = primitives[k];
  }
}

/// The light of point lights that surfaces scatter, per chance.
template <class T>
RAYGATE_INLINE Triple<T> point_light_contribution(const Hits<T>& hits, const Lights& lights,
                                                  const Triple<T>& position,
                                                  const Triple<T>& intensity, const T& chance) {
  const DirectionToLight<T> to_light(lights, hits.surface, position);
  const T cosine = at_least(dot(hits.surface.normal, to_light.direction), 0.0f);
  const Triple<T> light = hits.throughput * hits.bsdf.eval_for_point_light(to_light.direction) *
                          intensity * (cosine / (to_light.distance_squared * chance));
  return choose(to_light.is_in_front, bounded(light), zero<T>());
}

/// a^2 / (a^2 + b^2), where a may be infinite.
template <class T>
RAYGATE_INLINE T power_heuristic(const T& a, const T& b) {
  const T over = b / a;
  return 1.0f / (1.0f + over * over);
}

/// What is seen in a direction where nothing is; unit vectors.
template <class T>
RAYGATE_INLINE Triple<T> sky(const Lights& lights, const Triple<T>& direction) {
  const Environment* const environment = lights.environment();
  return environment != nullptr ? environment->radiance(direction) : spread<T>(lights.background());
}

/// The cosine between a spot light's axis and the way from it to the surface.
template <class T>
RAYGATE_INLINE T spot_cosine(const Hits<T>& hits, const Lights& lights, const Triple<T>& position,
                             const Triple<T>& axis) {
  return -dot(DirectionToLight<T>(lights, hits.surface, position).direction, axis);
}

/// The light of one direction that surfaces scatter, per chance; `towards` is a unit vector, and
/// `scattered` says how much of it.
template <class T>
RAYGATE_INLINE Triple<T> directional_light_contribution(const Hits<T>& hits,
                                                        const Triple<T>& towards,
                                                        const Triple<T>& scattered,
                                                        const Triple<T>& irradiance,
                                                        const T& chance) {
  const T cosine = at_least(dot(hits.surface.normal, towards), 0.0f);
  const Triple<T> light = hits.throughput * scattered * irradiance * (cosine / chance);
  return choose(dot(hits.surface.flat_normal, towards) > 0.0f, bounded(light), zero<T>());
}

/// The light of points of lights; `weighted` is radiance over the pdf of the point, per area,
/// and whatever else it is to be multiplied with.
template <class T>
RAYGATE_INLINE Triple<T> area_light_contribution(const Hits<T>& hits,
                                                 const DirectionToLight<T>& to_light,
                                                 const LightPoint<T>& point,
                                                 const Triple<T>& weighted) {
  const T cosines = at_least(dot(hits.surface.normal, to_light.direction), 0.0f) *
                    absolute(dot(point.normal, to_light.direction));
  const Triple<T> light = hits.throughput * hits.bsdf.eval(to_light.direction) *
                          (cosines / to_light.distance_squared) * weighted;
  return choose(to_light.is_in_front, bounded(light), zero<T>());
}

/// Rays that go on where `is_wanted`; `number` says which of their hits' rays they are.
template <class T>
struct ScatteredRays {
  Triple<T> direction, flat, throughput, scattered_at, normal;
  T pdf;
  WordOf<T> stream;
  MaskOf<T> is_wanted, has_flat, is_transmitted;

  RAYGATE_INLINE void send(Hits<T>& hits, std::size_t number) const {
    const Triple<T> ahead = scaled(direction);
    const auto leaving = hits.surface.leaving(ahead, is_transmitted);
    const auto wanted =
        Hits<T>::spread_out(is_wanted & (leaving.leaves | (!leaving.is_sure) | has_flat));
    const auto sure = Hits<T>::spread_out(leaving.leaves & leaving.is_sure),
               flats = Hits<T>::spread_out(has_flat), through = Hits<T>::spread_out(is_transmitted);
    const auto directions = Hits<T>::spread_out(ahead),
               flat_ones = Hits<T>::spread_out(scaled(flat)),
               throughputs = Hits<T>::spread_out(throughput),
               places = Hits<T>::spread_out(scattered_at), normals = Hits<T>::spread_out(normal);
    float pdfs[LanesOf<T>::kCount];
    std::uint32_t streams[LanesOf<T>::kCount];
    lanes_to(pdfs, pdf);
    lanes_to(streams, stream);
    for (int k = 0; k < hits.count; ++k) {
      if (wanted.values[0][k] == 0.0f) continue;
      ScatteredRay& ray = hits.block.scattered_ray(hits.place[k], number);
      ray.is_wanted = true;
      ray.surely_leaves = sure.values[0][k] != 0.0f;
      ray.has_flat = flats.values[0][k] != 0.0f;
      ray.side = through.values[0][k] != 0.0f ? SpawnSide::kTransmitted : SpawnSide::kIncident;
      ray.direction = Hits<T>::triple_of(directions, k);
      ray.flat = Hits<T>::triple_of(flat_ones, k);
      ray.state.throughput = Hits<T>::triple_of(throughputs, k);
      ray.state.pdf = pdfs[k];
      ray.state.scattered_at = Hits<T>::triple_of(places, k);
      ray.state.normal = Hits<T>::triple_of(normals, k);
      ray.state.stream = streams[k];
    }
  }
};

}  // namespace raygate
