// Hits that are shaded together: what goes into lanes, and what comes out of them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/lane_math.h"
#include "host/intersect/nearest_hit.h"
#include "host/light/bsdf.h"
#include "host/light/departure.h"
#include "host/light/finish.h"
#include "host/light/lights.h"
#include "host/light/sampler.h"
#include "host/light/shadow_catcher.h"
#include "host/light/surface.h"
#include "host/light/techniques.h"
#include "host/light/wave.h"

namespace raygate {

/// A question for a lamp's light. In a hit's list all lights have a place.
struct LightQuestion {
  enum State : std::uint8_t {
    kNotAsked,
    kBehind,  ///< nothing would arrive
    kAsked,
  };
  State state = kNotAsked;
  glm::vec3 light{0.0f};  ///< what arrives if nothing is between
  std::uint32_t lamp = 0;
  glm::vec3 place{0.0f};  ///< of an area light
  std::uint32_t slot = 0;
};

/// A ray that may go on.
struct WayOn {
  bool is_wanted = false;
  bool surely_leaves = false;  ///< the triangle, to that side; or else exact arithmetic decides
  bool has_flat = false;
  Departure side = Departure::kBefore;
  glm::vec3 direction{0.0f};  ///< scaled
  /// Where the direction, made with an interpolated normal, leads to the wrong side: that of the
  /// flat normal.
  glm::vec3 flat{0.0f};
  Burden burden;  ///< but for sample and index, which stay
};

/// A part of a wave, its hits, and what they give: lists by the ray's place in the part.
struct HitBlock {
  const Wave* wave = nullptr;
  std::size_t begin = 0;                 ///< in the wave
  std::vector<HitPlace> places;          ///< no face: nothing is hit
  std::vector<const Finish*> finishes;   ///< of the hits
  std::vector<glm::vec3> radiance;       ///< along the ray, already weighted
  std::vector<LightQuestion> questions;  ///< `questions_each` of each hit
  std::vector<WayOn> ways;               ///< `ways_each` of each hit
  std::size_t questions_each = 0, ways_each = 0;
  FirstSurface* first_surfaces = nullptr;  ///< by sample; none after the camera's rays

  [[nodiscard]] const Burden& burden(std::size_t i) const { return wave->burdens[begin + i]; }
  [[nodiscard]] LightQuestion& question(std::size_t i, std::size_t number) {
    return questions[i * questions_each + number];
  }
  [[nodiscard]] WayOn& way(std::size_t i, std::size_t number) {
    return ways[i * ways_each + number];
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
  bool sees_environment = true;   ///< rays that hit nothing
  bool asks_environment = false;  ///< surfaces, as they do lamps
  Techniques techniques{};
};

/// As many hits of one kind as T has lanes.
template <class T>
struct Hits {
  static constexpr int kCount = LanesOf<T>::kCount;

  /// `at` says where in the block; where there are fewer than lanes, the last one fills the rest.
  RAYGATE_INLINE Hits(const ShadingScene& shading, HitBlock& hits, HitKind hit_kind,
                      std::span<const std::uint32_t> at)
      : block(hits), kind(hit_kind), count(static_cast<int>(at.size())) {
    enum : std::uint8_t { kWeight, kDensity = 3, kScatteredAt = 4, kNormal = 7, kFields = 10 };
    Gathered<T, kFields> in;
    Gathered<T, 2, std::uint32_t> words;
    HitPlace places[kCount];
    const Finish* finishes[kCount];
    for (int k = 0; k < kCount; ++k) {
      place[k] = at[static_cast<std::size_t>(k < count ? k : count - 1)];
      const Burden& burden = hits.burden(place[k]);
      in.put(kWeight, k, burden.weight);
      in.values[kDensity][k] = burden.density;
      in.put(kScatteredAt, k, burden.scattered_at);
      in.put(kNormal, k, burden.normal);
      words.values[0][k] = burden.stream;
      words.values[1][k] = burden.index;
      places[k] = hits.places[place[k]];
      finishes[k] = hits.finishes[place[k]];
    }
    weight = in.triple(kWeight);
    density = in.one(kDensity);
    scattered_at = in.triple(kScatteredAt);
    scattering_normal = in.triple(kNormal);
    stream = words.one(0);
    index = words.one(1);
    surface = surface_at<T>(shading.scene, shading.bvh, kind, places);
    if ((kind & kCatchesShadows) != 0) {
      surface.colour = catcher_colour(shading.lights, shading.ambient, surface);
    }
    bsdf = Bsdf<T>(surface, kind, finishes);
    if (hits.first_surfaces != nullptr) show_first_surfaces();
  }

  /// A point of the rays' own random streams for this purpose.
  [[nodiscard]] RAYGATE_INLINE SquarePoint<T> random(std::uint32_t purpose) const {
    return square_point<T>(index, mixed(stream, purpose));
  }

  RAYGATE_INLINE void set_radiance(const Triple<T>& radiance) {
    Gathered<T, 3> out = spread_out(radiance);
    for (int k = 0; k < count; ++k) block.radiance[place[k]] = triple_of(out, k);
  }

  HitBlock& block;
  HitKind kind;
  int count;
  std::uint32_t place[kCount];  ///< in the block
  Triple<T> weight, scattered_at, scattering_normal;
  T density;
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
      block.first_surfaces[block.burden(place[k]).sample] = {triple_of(normals, k),
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
struct WayToLight {
  Triple<T> direction;  ///< unit vector
  T squared, distance;
  MaskOf<T> is_before;  ///< it leads away from the surface, and somewhere

  RAYGATE_INLINE WayToLight(const Lights& lights, const Surface<T>& surface,
                            const Triple<T>& place) {
    constexpr float kNear = 1e-30f;  // floats have room for the inverse
    const Triple<T> way = (place - surface.point) * spread<T>(lights.per_unit());
    squared = dot(way, way);
    distance = root(squared);
    direction = way * (1.0f / distance);
    is_before = (squared > kNear) & (dot(surface.flat_normal, direction) > 0.0f);
  }
};

/// Asks for light that is `light` where nothing is between; `number` is the question's in its hit's
/// list.
template <class T>
RAYGATE_INLINE void ask(Hits<T>& hits, std::size_t number, const MaskOf<T>& is_asked,
                        const Triple<T>& light, const std::uint32_t (&lamps)[LanesOf<T>::kCount],
                        const LightPoint<T>& point) {
  const Gathered<T, 1> asked = Hits<T>::spread_out(is_asked);
  const Gathered<T, 3> lights = Hits<T>::spread_out(light);
  const Gathered<T, 3> places = Hits<T>::spread_out(point.position);
  std::uint32_t slots[LanesOf<T>::kCount];
  lanes_to(slots, point.slot);
  for (int k = 0; k < hits.count; ++k) {
    if (asked.values[0][k] == 0.0f) continue;
    LightQuestion& question = hits.block.question(hits.place[k], number);
    question.light = Hits<T>::triple_of(lights, k);
    const bool is_dark = question.light == glm::vec3(0.0f);
    question.state = is_dark ? LightQuestion::kBehind : LightQuestion::kAsked;
    question.lamp = lamps[k];
    question.place = Hits<T>::triple_of(places, k);
    question.slot = slots[k];
  }
}

/// The light of point lights that surfaces scatter, per chance.
template <class T>
RAYGATE_INLINE Triple<T> light_from_point(const Hits<T>& hits, const Lights& lights,
                                          const Triple<T>& position, const Triple<T>& intensity,
                                          const T& chance) {
  const WayToLight<T> way(lights, hits.surface, position);
  const T cosine = at_least(dot(hits.surface.normal, way.direction), 0.0f);
  const Triple<T> light = hits.weight * hits.bsdf.scattered_from_point(way.direction) * intensity *
                          (cosine / (way.squared * chance));
  return choose(way.is_before, bounded(light), zero<T>());
}

/// a^2 / (a^2 + b^2), where a may be infinite.
template <class T>
RAYGATE_INLINE T share_of(const T& a, const T& b) {
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
  return -dot(WayToLight<T>(lights, hits.surface, position).direction, axis);
}

/// The light of one direction that surfaces scatter, per chance; `towards` is a unit vector, and
/// `scattered` says how much of it.
template <class T>
RAYGATE_INLINE Triple<T> light_from_direction(const Hits<T>& hits, const Triple<T>& towards,
                                              const Triple<T>& scattered,
                                              const Triple<T>& irradiance, const T& chance) {
  const T cosine = at_least(dot(hits.surface.normal, towards), 0.0f);
  const Triple<T> light = hits.weight * scattered * irradiance * (cosine / chance);
  return choose(dot(hits.surface.flat_normal, towards) > 0.0f, bounded(light), zero<T>());
}

/// The light of points of lamps; `weighted` is radiance over the density of the point, per area,
/// and whatever else it is to be multiplied with.
template <class T>
RAYGATE_INLINE Triple<T> light_from_area(const Hits<T>& hits, const WayToLight<T>& way,
                                         const LightPoint<T>& point, const Triple<T>& weighted) {
  const T cosines = at_least(dot(hits.surface.normal, way.direction), 0.0f) *
                    absolute(dot(point.normal, way.direction));
  const Triple<T> light =
      hits.weight * hits.bsdf.scattered(way.direction) * (cosines / way.squared) * weighted;
  return choose(way.is_before, bounded(light), zero<T>());
}

/// Rays that go on where `is_wanted`; `number` is the way's in its hit's list.
template <class T>
struct WaysOn {
  Triple<T> direction, flat, weight, scattered_at, normal;
  T density;
  WordOf<T> stream;
  MaskOf<T> is_wanted, has_flat, is_through;

  RAYGATE_INLINE void send(Hits<T>& hits, std::size_t number) const {
    const Triple<T> ahead = scaled(direction);
    const auto leaving = hits.surface.leaving(ahead, is_through);
    const auto wanted =
        Hits<T>::spread_out(is_wanted & (leaving.leaves | (!leaving.is_sure) | has_flat));
    const auto sure = Hits<T>::spread_out(leaving.leaves & leaving.is_sure),
               flats = Hits<T>::spread_out(has_flat), through = Hits<T>::spread_out(is_through);
    const auto directions = Hits<T>::spread_out(ahead),
               flat_ones = Hits<T>::spread_out(scaled(flat)), weights = Hits<T>::spread_out(weight),
               places = Hits<T>::spread_out(scattered_at), normals = Hits<T>::spread_out(normal);
    float densities[LanesOf<T>::kCount];
    std::uint32_t streams[LanesOf<T>::kCount];
    lanes_to(densities, density);
    lanes_to(streams, stream);
    for (int k = 0; k < hits.count; ++k) {
      if (wanted.values[0][k] == 0.0f) continue;
      WayOn& way = hits.block.way(hits.place[k], number);
      way.is_wanted = true;
      way.surely_leaves = sure.values[0][k] != 0.0f;
      way.has_flat = flats.values[0][k] != 0.0f;
      way.side = through.values[0][k] != 0.0f ? Departure::kAfter : Departure::kBefore;
      way.direction = Hits<T>::triple_of(directions, k);
      way.flat = Hits<T>::triple_of(flat_ones, k);
      way.burden.weight = Hits<T>::triple_of(weights, k);
      way.burden.density = densities[k];
      way.burden.scattered_at = Hits<T>::triple_of(places, k);
      way.burden.normal = Hits<T>::triple_of(normals, k);
      way.burden.stream = streams[k];
    }
  }
};

}  // namespace raygate
