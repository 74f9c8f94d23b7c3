// Where light comes from.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/base/lane_math.h"
#include "host/bvh/bvh.h"
#include "host/light/environment.h"
#include "host/light/light_tree.h"
#include "host/light/outer_sides.h"
#include "host/light/sampler.h"
#include "host/light/spot.h"
#include "host/scene/scene.h"

namespace raygate {

/// The emitting faces of one object and material: one light, which shines to both sides of each
/// face.
struct AreaLight {
  std::vector<std::uint32_t> primitives;
  std::vector<double> area_up_to;   ///< of the primitives so far, each included
  glm::vec3 low{0.0f}, high{0.0f};  ///< of the box around it
  glm::dvec3 radiance{0.0};
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

/// All lights of a scene, ready for use. Lengths in what is asked of a surface (areas, distances)
/// are in units of `unit()`: floats have room for their squares then.
class Lights {
 public:
  /// The references must outlive this. Without a `choice` there are no sources, and none of what
  /// they are chosen by.
  Lights(const Scene& scene, const Bvh& bvh, LightSampling choice = LightSampling::kTree);

  [[nodiscard]] std::span<const PointLight> points() const { return scene_.lights; }
  [[nodiscard]] std::span<const AreaLight> areas() const { return areas_; }
  [[nodiscard]] std::span<const DirectionalLight> directions() const {
    return scene_.directional_lights;
  }
  /// nullptr: there is none, but a background.
  [[nodiscard]] const Environment* environment() const {
    return environment_ ? &*environment_ : nullptr;
  }
  /// Of an environment the mean.
  [[nodiscard]] glm::vec3 background() const {
    return environment_ ? glm::vec3(environment_->mean_radiance()) : scene_.background;
  }
  /// Radiance from all sides that may stand for light that goes from surface to surface: the
  /// background's or, where that is black, what the lights' flux would come to after many
  /// reflections if it were spread evenly over all surfaces ("A progressive refinement approach to
  /// fast radiosity image generation", Cohen, Chen, Wallace and Greenberg 1988, has such a term).
  [[nodiscard]] glm::dvec3 ambient() const;
  /// Points first, then areas, then directions, then the environment.
  [[nodiscard]] std::size_t count() const { return lights_.size(); }

  /// The inverse of a power of two about as long as the scene.
  [[nodiscard]] float per_unit() const { return per_unit_; }

  enum class Kind : std::uint8_t { kPoint, kArea, kDirection, kEnvironment };

  /// What shading reads of a light, by its index as in count().
  struct Light {
    Kind kind = Kind::kPoint;
    bool is_spot = false;
    /// Of a point light its intensity, in square units; of an area light radiance; of light from
    /// one direction irradiance; of the environment nothing.
    glm::vec3 emission{0.0f};
    glm::vec3 position{0.0f};  ///< of a point light; or the direction towards the light
    SpotFalloff spot;
    float area = 0.0f;  ///< in square units
    float sky = 0.0f;   ///< of an area light: the background's radiance over its own, at most 1/2
    std::uint32_t first_patch = 0, patches = 0;
  };
  [[nodiscard]] const Light& light(std::size_t index) const { return lights_[index]; }

  /// Points of area lights, uniform in area, for points of the unit square.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample(
      const std::uint32_t (&indices)[LanesOf<T>::kCount], const SquarePoint<T>& u) const;
  /// The same of one patch each.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample_patches(
      const std::uint32_t (&patches)[LanesOf<T>::kCount], const SquarePoint<T>& u) const;
  /// The middle of a flat light, or very near, as a sample. Its primitive is one of the light's.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static LightPoint<T> middle(const AreaLight& light) {
    return {spread<T>(glm::vec3(light.middle)), spread<T>(glm::vec3(light.middle_normal)),
            spread<WordOf<T>>(light.primitives[0])};
  }

  // For those who ask one light at a time:

  /// What is chosen: a light, or of an area light a patch: a triangle, or two of them.
  struct Source {
    std::uint32_t light = 0;         ///< as in count()
    std::uint32_t patch = kNoIndex;  ///< of an area light
    float per_area = 0.0f;           ///< of a patch: 1 / its area in square units
  };
  [[nodiscard]] const Source& source(std::size_t index) const { return sources_[index]; }
  /// Which one a primitive belongs to; kNoIndex for none.
  [[nodiscard]] std::uint32_t source_of(std::uint32_t primitive) const {
    return primitive < source_of_slot_.size() ? source_of_slot_[primitive] : kNoIndex;
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
                  slot_beyond = 0;   ///< with more of u than of v, and the other way round
    float begin = 0.0f, end = 0.0f;  ///< its part of the light's area, in [0, 1]
    double area = 0.0;
    bool is_triangle = true;
  };

  void find_areas();
  void add_patches(const AreaLight& light, Light& record);
  void add_sources(LightSampling choice, double unit);
  [[nodiscard]] static LightBounds light_bounds(const Patch& patch, const AreaLight& light,
                                                double unit, OuterSide side);

  const Scene& scene_;
  const Bvh& bvh_;
  std::optional<Environment> environment_;
  std::vector<AreaLight> areas_;
  std::vector<Light> lights_;
  std::vector<Patch> patches_;
  std::vector<float> patch_ends_;              // of the patches, for searching
  std::vector<Source> sources_;                // as in count(), patch by patch
  std::vector<std::uint32_t> source_of_slot_;  // or kNoIndex; empty: none at all. No instance emits
  LightTree tree_;
  bool any_power_ = false;
  float per_unit_ = 1.0f;
};

template <class T>
RAYGATE_INLINE LightPoint<T> Lights::sample(const std::uint32_t (&indices)[LanesOf<T>::kCount],
                                            const SquarePoint<T>& u) const {
  constexpr int kCount = LanesOf<T>::kCount;
  Gathered<T, 2> in;
  std::uint32_t patches[kCount];
  float wanted[kCount];
  lanes_to(wanted, u.x);
  for (int k = 0; k < kCount; ++k) {
    const Light& light = lights_[indices[k]];
    const auto first = patch_ends_.begin() + light.first_patch;
    const auto found = std::upper_bound(first, first + light.patches - 1, wanted[k]);
    patches[k] = static_cast<std::uint32_t>(found - patch_ends_.begin());
    in.values[0][k] = patches_[patches[k]].begin;
    in.values[1][k] = patches_[patches[k]].end;
  }
  const T begin = in.one(0), size = in.one(1) - begin;
  return sample_patches<T>(patches, {at_most(at_least((u.x - begin) / size, 0.0f), 1.0f), u.y});
}

template <class T>
RAYGATE_INLINE LightPoint<T> Lights::sample_patches(
    const std::uint32_t (&patches)[LanesOf<T>::kCount], const SquarePoint<T>& u) const {
  enum : std::uint8_t { kCorner, kU = 3, kV = 6, kNormal = 9, kTriangle = 12, kFields };
  Gathered<T, kFields> in;
  Gathered<T, 2, std::uint32_t> primitives;
  for (int k = 0; k < LanesOf<T>::kCount; ++k) {
    const Patch& patch = patches_[patches[k]];
    in.put(kCorner, k, patch.corner);
    in.put(kU, k, patch.u);
    in.put(kV, k, patch.v);
    in.put(kNormal, k, patch.normal);
    in.values[kTriangle][k] = patch.is_triangle ? 1.0f : 0.0f;
    primitives.values[0][k] = patch.primitive;
    primitives.values[1][k] = patch.slot_beyond;
  }
  // The square onto the triangle: sqrt keeps areas.
  const auto is_triangle = in.one(kTriangle) > 0.0f;
  const T far = root(u.x);
  const T along_u = choose(is_triangle, far * (1.0f - u.y), u.x);
  const T along_v = choose(is_triangle, far * u.y, u.y);
  return {in.triple(kCorner) + in.triple(kU) * along_u + in.triple(kV) * along_v,
          in.triple(kNormal),
          choose(is_triangle | (along_u > along_v), primitives.one(0), primitives.one(1))};
}

}  // namespace raygate
