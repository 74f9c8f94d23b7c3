// Lights: point, area, directional and environment lights of a scene, ready for sampling.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/base/triple.h"
#include "host/bvh/bvh.h"
#include "host/light/default_lights.h"
#include "host/light/environment.h"
#include "host/light/light_tree.h"
#include "host/light/sampler.h"
#include "host/scene/scene.h"

namespace raygate {

/// A float that is no infinity.
[[nodiscard]] inline float finite_float(double x) {
  return static_cast<float>(std::min(x, double{std::numeric_limits<float>::max()}));
}
[[nodiscard]] inline glm::vec3 finite_floats(const glm::dvec3& x) {
  return {finite_float(x.x), finite_float(x.y), finite_float(x.z)};
}

/// A SpotCone as shading reads it: KHR_lights_punctual's ramp of the cosine from the axis.
struct SpotFalloff {
  glm::vec3 axis{0.0f};
  float scale = 0.0f, offset = 1.0f;  ///< of a light to all sides: 1 everywhere

  SpotFalloff() = default;
  explicit SpotFalloff(const SpotCone& cone) : axis(cone.axis) {
    constexpr double kLeastRamp = 1e-6;
    const double inner = sine_cosine(cone.inner / 360.0).cosine;
    const double outer = sine_cosine(cone.outer / 360.0).cosine;
    const double slope = 1.0 / (inner - outer > kLeastRamp ? inner - outer : kLeastRamp);
    scale = static_cast<float>(slope);
    offset = static_cast<float>(-outer * slope);
  }
};

/// The share of the intensity at an angle from the axis with this cosine: 1 within the cone's inner
/// angle, 0 beyond its outer one.
template <class T>
RAYGATE_INLINE T spot_falloff(const T& cosine, const T& scale, const T& offset) {
  const T ramp = at_most(at_least(cosine * scale + offset, 0.0f), 1.0f);
  return ramp * ramp;
}

/// Of a triangle: which of its sides is seen from outside of what it encloses.
enum class OuterSide : std::uint8_t {
  kBoth,           ///< it is no part of a closed surface, or not surely
  kAlongNormal,    ///< that of its normal
  kAgainstNormal,  ///< the other
};

/// For each of some primitives. A closed surface is a set of these triangles that hang together by
/// their edges, each edge of just two of them, which run along it in opposite directions. Where
/// anything else of the scene is within the box around it, it counts as open.
[[nodiscard]] std::vector<OuterSide> outer_sides(const Bvh& bvh,
                                                 std::span<const std::uint32_t> primitives);

/// The emitting faces of one object and material: one light, which shines to both sides of each
/// face.
struct AreaLight {
  std::vector<std::uint32_t> primitives;
  std::vector<double> area_up_to;   ///< of the primitives so far, each included
  glm::vec3 low{0.0f}, high{0.0f};  ///< of the box around it
  glm::dvec3 radiance{0.0};         ///< in the mean
  bool is_textured = false;
  bool is_flat = false;
  glm::dvec3 middle{0.0}, middle_normal{0.0};  ///< of a flat one

  [[nodiscard]] double area() const { return area_up_to.back(); }
};

/// Points of lights, one a lane.
template <class T>
struct LightPoint {
  /// Of a light that is infinitely far away a unit vector towards it, and no normal.
  Triple<T> position, normal;  ///< the normal to one of both sides
  WordOf<T> primitive;         ///< NearestHit::kNone: infinitely far away
};

/// All lights of a scene. Areas and distances are in units of about the scene's length: floats have
/// room for their squares then.
class Lights {
 public:
  /// How an integrator samples the lights.
  enum class Sampling : std::uint8_t {
    kAll,  ///< every light at each hit (Whitted): there are no sources
    kOne,  ///< one at each hit, chosen by LightTree (paths): there is no ambient light
  };

  /// The references must outlive this. `camera_lights` take the place of the scene's.
  Lights(const Scene& scene, const Bvh& bvh, Sampling sampling = Sampling::kOne,
         const std::optional<CameraLights>& camera_lights = {});

  [[nodiscard]] std::span<const PointLight> points() const { return own_.points; }
  [[nodiscard]] std::span<const AreaLight> areas() const { return areas_; }
  [[nodiscard]] std::span<const DirectionalLight> directions() const {
    return scene_.directional_lights;
  }
  /// nullptr: there is none, but a background.
  [[nodiscard]] const Environment* environment() const {
    return environment_ ? &*environment_ : nullptr;
  }
  /// Whether that is none of the scene's, which the camera does not see.
  [[nodiscard]] bool has_studio() const { return own_.studio.has_value(); }
  /// The radiance from all sides that lights a floor as much as the background or the studio does.
  [[nodiscard]] const glm::vec3& light_from_above() const { return from_above_; }
  /// Of an environment the mean.
  [[nodiscard]] glm::vec3 background() const {
    return environment_ ? glm::vec3(environment_->mean_radiance()) : own_.background;
  }
  /// Radiance from all sides that may stand for light that goes from surface to surface: the
  /// background's or, where that is black, what the lights' flux would come to after many
  /// reflections if it were spread evenly over all surfaces ("A progressive refinement approach to
  /// fast radiosity image generation", Cohen, Chen, Wallace and Greenberg 1988, has such a term).
  [[nodiscard]] const glm::dvec3& ambient() const { return ambient_; }
  /// Points first, then areas, then directions, then the environment.
  [[nodiscard]] std::size_t count() const { return lights_.size(); }

  /// The inverse of a power of two about as long as the scene.
  [[nodiscard]] float per_unit() const { return per_unit_; }

  enum class Kind : std::uint8_t { kNone, kPoint, kArea, kDirection, kEnvironment };

  /// What shading reads of a light, by its index as in count().
  struct Light {
    Kind kind = Kind::kPoint;
    bool is_spot = false;
    /// Of a point light its intensity, in square units; of an area light radiance; of light from
    /// one direction irradiance; of the environment nothing.
    glm::vec3 emission{0.0f};
    glm::vec3 position{0.0f};  ///< of a point light; or the direction towards the light
    float radius = 0.0f;       ///< of a point light: it is a ball, beyond all of the scene
    SpotFalloff spot;
    float area = 0.0f;         ///< in square units
    bool is_textured = false;  ///< `emission` is the mean; radiance_at() has it at a point
    float sky = 0.0f;  ///< of an area light: the background's radiance over its own, at most 1/2
    std::uint32_t first_patch = 0, patches = 0;
  };
  [[nodiscard]] const Light& light(std::size_t index) const { return lights_[index]; }

  /// Points of area lights, uniform in area, for points of the unit square.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample(const std::uint32_t (&indices)[kLanesOf<T>],
                                                    const SquarePoint<T>& u) const;
  /// The same of one patch each.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample_patches(
      const std::uint32_t (&numbers)[kLanesOf<T>], const SquarePoint<T>& u) const;
  /// The middle of a flat light, or very near, as a sample. Its primitive is one of the light's.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static LightPoint<T> middle(const AreaLight& light) {
    return {spread<T>(glm::vec3(light.middle)), spread<T>(glm::vec3(light.middle_normal)),
            spread<WordOf<T>>(light.primitives[0])};
  }

  /// The radiance of area lights at points of them, one light and one point a lane. Of what is no
  /// area light its emission.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE Triple<T> radiance_at(const Light* const (&lights)[kLanesOf<T>],
                                                     const LightPoint<T>& at) const {
    const Triple<T> emission = gather<T>(lights, &Light::emission);
    if (!any(gather<T>(lights, &Light::is_textured))) return emission;
    const auto plain = unpack(emission), points = unpack(at.position);
    const auto primitives = unpack(at.primitive);
    return gather<T>([&](int k) RAYGATE_BODY {
      return lights[k]->is_textured ? textured_radiance(primitives[k], points[k]) : plain[k];
    });
  }

  /// Where on a point light light comes from to a place: its position, or a point of its disc.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static Triple<T> point_on(const Triple<T>& position, const T& radius,
                                                         const Triple<T>& from,
                                                         const SquarePoint<T>& u) {
    const auto turn = sine_cosine(wide(u.y));
    const Triple<T> towards = normalized(from - position);
    return position + spherical_direction(towards, T{}, radius * root(u.x), narrow(turn.cosine),
                                          narrow(turn.sine));
  }

  // For sampling one light at a time:

  /// What the light tree chooses: a light, or a patch (a triangle or two) of an area light.
  struct Source {
    std::uint32_t light = 0;         ///< as in count()
    std::uint32_t patch = kNoIndex;  ///< of an area light
    float per_area = 0.0f;           ///< of a patch: 1 / its area in square units
  };
  [[nodiscard]] std::size_t source_count() const { return sources_.size(); }
  [[nodiscard]] const Source& source(std::size_t index) const { return sources_[index]; }
  /// Which one a primitive belongs to; kNoIndex for none.
  [[nodiscard]] std::uint32_t source_of(std::uint32_t primitive) const {
    return primitive < source_of_primitive_.size() ? source_of_primitive_[primitive] : kNoIndex;
  }
  /// There is at most one; the last.
  [[nodiscard]] std::uint32_t environment_source() const {
    return static_cast<std::uint32_t>(sources_.size() - 1);
  }

  /// Whether there is a light, and not all are dark.
  [[nodiscard]] bool any_power() const { return any_power_; }
  /// One source for a point of a surface and its unit normal: see LightTree. Only where
  /// any_power().
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightTree::Sample sample_source(const glm::vec3& point,
                                                               const glm::vec3& normal,
                                                               double u) const {
    if (sources_.size() == 1) return {0, 1.0f};
    return tree_.sample<T>(point * per_unit_, normal, u);
  }
  /// How likely sample_source() is to give a source.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE float pmf(std::uint32_t source, const glm::vec3& point,
                                         const glm::vec3& normal) const {
    if (sources_.size() == 1) return 1.0f;
    return tree_.pmf<T>(source, point * per_unit_, normal);
  }

 private:
  /// A part of a light: a triangle, or two that make a parallelogram.
  struct Patch {
    glm::vec3 corner{0.0f}, u{0.0f}, v{0.0f}, normal{0.0f};
    std::uint32_t primitive = 0,
                  primitive_beyond = 0;  ///< with more of u than of v, and the other way round
    float begin = 0.0f, end = 0.0f;      ///< its part of the light's area, in [0, 1]
    double area = 0.0;
    bool is_triangle = true;
  };

  [[nodiscard]] glm::vec3 textured_radiance(std::uint32_t primitive, const glm::vec3& point) const;
  void find_areas();
  void add_patches(const AreaLight& light, Light& record);
  void add_sources(double unit);
  [[nodiscard]] static LightBounds light_bounds(const Patch& patch, const AreaLight& light,
                                                double unit, OuterSide side);

  const Scene& scene_;
  const Bvh& bvh_;
  CameraLights own_;
  std::optional<Environment> environment_;
  glm::vec3 from_above_{0.0f};
  glm::dvec3 ambient_{0.0};
  std::vector<AreaLight> areas_;
  std::vector<Light> lights_;
  std::vector<Patch> patches_;
  std::vector<float> patch_ends_;  // of the patches, for searching
  std::vector<Source> sources_;    // as in count(), patch by patch
  std::vector<std::uint32_t>
      source_of_primitive_;  // or kNoIndex; empty: none at all. No instance emits
  LightTree tree_;
  bool any_power_ = false;
  float per_unit_ = 1.0f;
};

template <class T>
RAYGATE_INLINE LightPoint<T> Lights::sample(const std::uint32_t (&indices)[kLanesOf<T>],
                                            const SquarePoint<T>& u) const {
  constexpr int kCount = kLanesOf<T>;
  const auto wanted = unpack(u.x);
  std::uint32_t numbers[kCount];
  const Patch* patches[kCount];
  for (int k = 0; k < kCount; ++k) {
    const Light& light = lights_[indices[k]];
    const auto first = patch_ends_.begin() + light.first_patch;
    const auto found = std::upper_bound(first, first + light.patches - 1, wanted[k]);
    numbers[k] = static_cast<std::uint32_t>(found - patch_ends_.begin());
    patches[k] = &patches_[numbers[k]];
  }
  const T begin = gather<T>(patches, &Patch::begin), size = gather<T>(patches, &Patch::end) - begin;
  return sample_patches<T>(numbers, {at_most(at_least((u.x - begin) / size, 0.0f), 1.0f), u.y});
}

template <class T>
RAYGATE_INLINE LightPoint<T> Lights::sample_patches(const std::uint32_t (&numbers)[kLanesOf<T>],
                                                    const SquarePoint<T>& u) const {
  const Patch* patches[kLanesOf<T>];
  for (int k = 0; k < kLanesOf<T>; ++k) patches[k] = &patches_[numbers[k]];
  // The square onto the triangle: sqrt keeps areas.
  const MaskOf<T> is_triangle = gather<T>(patches, &Patch::is_triangle);
  const T far = root(u.x);
  const T along_u = choose(is_triangle, far * (1.0f - u.y), u.x);
  const T along_v = choose(is_triangle, far * u.y, u.y);
  return {gather<T>(patches, &Patch::corner) + gather<T>(patches, &Patch::u) * along_u +
              gather<T>(patches, &Patch::v) * along_v,
          gather<T>(patches, &Patch::normal),
          choose(is_triangle | (along_u > along_v), gather<T>(patches, &Patch::primitive),
                 gather<T>(patches, &Patch::primitive_beyond))};
}

}  // namespace raygate
