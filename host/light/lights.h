// Lights: point, area, directional and environment lights of a scene, ready for sampling.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/light/environment.h"
#include "host/light/light_tree.h"

namespace raygate {

class Camera;

/// Lights that belong to a camera. They replace the scene's point lights and background.
struct CameraLights {
  std::vector<PointLight> points;
  glm::vec3 background{0.0f};
  /// Radius of spheres that replace the points, for soft shadows. They are outside the scene.
  double radius = 0.0;
};

/// Returns lights for a scene that has none: no lights, no background, and no emission except by
/// textures that hardly light anything. The default lights are a dim sky and a light with soft
/// shadows to the upper left of the camera, or at a camera inside the scene. Returns nullopt for
/// other scenes. With `is_preview`, for cameras not chosen by the user, there is a second, weaker
/// light from the right, and scenes with only a background or dim emitters get lights, too.
[[nodiscard]] std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera,
                                                         bool is_preview = false);

/// Returns x as a float; the largest float instead of infinity.
[[nodiscard]] inline float finite_float(double x) {
  return static_cast<float>(std::min(x, double{std::numeric_limits<float>::max()}));
}
[[nodiscard]] inline glm::vec3 finite_floats(const glm::dvec3& x) {
  return {finite_float(x.x), finite_float(x.y), finite_float(x.z)};
}

/// Returns the fraction of a spot light's intensity in a direction with this cosine to the axis: 1
/// within the inner angle, 0 beyond the outer angle (the ramp of KHR_lights_punctual). `scale` and
/// `offset` are Lights::Light::spot_scale and ::spot_offset.
template <class T>
RAYGATE_INLINE T spot_falloff(const T& cosine, const T& scale, const T& offset) {
  const T ramp = at_most(at_least(cosine * scale + offset, 0.0f), 1.0f);
  return ramp * ramp;
}

/// Side of a triangle that faces out of the closed surface to which the triangle belongs.
enum class OuterSide : std::uint8_t {
  kBoth,           ///< the triangle does not belong to a closed surface
  kAlongNormal,    ///< the side of its normal
  kAgainstNormal,  ///< the opposite side
};

/// Returns the outer side of each primitive. A closed surface is a set of primitives connected by
/// edges, each of which belongs to exactly two triangles that traverse it in opposite directions.
[[nodiscard]] std::vector<OuterSide> outer_sides(const Bvh& bvh,
                                                 std::span<const std::uint32_t> primitives);

/// The emitting faces of one object and material, as one light. Both sides of each face emit.
struct AreaLight {
  std::vector<std::uint32_t> primitives{};
  double area = 0.0;
  glm::vec3 low{0.0f}, high{0.0f};  ///< bounds
  glm::dvec3 radiance{0.0};         ///< mean
  bool is_textured = false;
};

/// A point of an area light in each lane.
template <class T>
struct LightPoint {
  Triple<T> position, normal;  ///< unit normal of either side
  WordOf<T> primitive;
};

/// All lights of a scene. The unit of areas and distances is about the scene's size, which keeps
/// squares within the range of float; see per_unit().
class Lights {
 public:
  /// How an integrator samples the lights.
  enum class Sampling : std::uint8_t {
    kAll,  ///< every light at each hit (Whitted); source_count() is 0
    kOne,  ///< one light at each hit, chosen by LightTree (paths); ambient() is 0
  };

  /// The references must outlive this object. `camera_lights` replace the scene's own lights.
  Lights(const Scene& scene, const Bvh& bvh, Sampling sampling = Sampling::kOne,
         const std::optional<CameraLights>& camera_lights = {});

  [[nodiscard]] std::span<const PointLight> points() const { return own_.points; }
  [[nodiscard]] std::span<const AreaLight> areas() const { return areas_; }
  /// Returns null if there is only a background.
  [[nodiscard]] const Environment* environment() const {
    return environment_ ? &*environment_ : nullptr;
  }
  /// Returns the radiance of the background; for an environment, its mean.
  [[nodiscard]] glm::vec3 background() const {
    return environment_ ? glm::vec3(environment_->mean_radiance()) : own_.background;
  }
  /// Returns the uniform radiance that approximates interreflection: the background's or, if the
  /// background is black, the lights' flux after many reflections, spread evenly over all surfaces
  /// ("A progressive refinement approach to fast radiosity image generation", Cohen, Chen, Wallace
  /// and Greenberg 1988). 0 with Sampling::kOne.
  [[nodiscard]] const glm::dvec3& ambient() const { return ambient_; }
  /// Returns the number of lights: point, area and directional lights, then the environment.
  [[nodiscard]] std::size_t count() const { return lights_.size(); }

  /// Returns 1 / the unit of length, a power of two of about the size of the scene.
  [[nodiscard]] float per_unit() const { return per_unit_; }

  enum class Kind : std::uint8_t { kNone, kPoint, kArea, kDirection, kEnvironment };

  /// A light in the format used for shading, by index below count().
  struct Light {
    Kind kind = Kind::kPoint;
    bool is_spot = false;
    /// Point light: intensity over the squared unit. Area light: radiance. Directional light:
    /// irradiance. Environment: unused.
    glm::vec3 emission{0.0f};
    glm::vec3 position{0.0f};   ///< of a point light, or the direction towards a directional light
    float radius = 0.0f;        ///< of a point light that is a sphere, outside the scene
    glm::vec3 spot_axis{0.0f};  ///< of a spot light; scale, offset: see spot_falloff()
    float spot_scale = 0.0f, spot_offset = 1.0f;
    float area = 0.0f;         ///< in square units
    bool is_textured = false;  ///< `emission` is the mean radiance; see radiance_at()
    std::uint32_t first_patch = 0, patches = 0;
  };
  [[nodiscard]] const Light& light(std::size_t index) const { return lights_[index]; }

  /// Samples points of an area light, uniform in area, for points of the unit square.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample(const Light& light,
                                                    const SquarePoint<T>& u) const {
    constexpr int kCount = kLanesOf<T>;
    const auto wanted = unpack(u.x);
    std::uint32_t numbers[kCount];
    const Patch* patches[kCount];
    const std::span all = std::span(patches_).subspan(light.first_patch, light.patches - 1);
    for (int k = 0; k < kCount; ++k) {
      const auto found = std::ranges::upper_bound(all, wanted[k], {}, &Patch::end);
      numbers[k] = light.first_patch + static_cast<std::uint32_t>(found - all.begin());
      patches[k] = &patches_[numbers[k]];
    }
    const T begin = gather<T>(patches, &Patch::begin),
            size = gather<T>(patches, &Patch::end) - begin;
    return sample_patches<T>(numbers, {at_most(at_least((u.x - begin) / size, 0.0f), 1.0f), u.y});
  }
  /// Samples points of one patch per lane, uniform in area.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightPoint<T> sample_patches(
      const std::uint32_t (&numbers)[kLanesOf<T>], const SquarePoint<T>& u) const {
    const Patch* patches[kLanesOf<T>];
    for (int k = 0; k < kLanesOf<T>; ++k) patches[k] = &patches_[numbers[k]];
    // Maps the square to the triangle; sqrt preserves areas.
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

  /// Returns the radiance of area lights at points on them; of other lights, the emission.
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

  /// Samples a point of the disc that a spherical point light presents to the point `from`.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE static Triple<T> point_on(const Triple<T>& position, const T& radius,
                                                         const Triple<T>& from,
                                                         const SquarePoint<T>& u) {
    return position +
           spherical_direction(normalized(from - position), T{}, radius * root(u.x), u.y);
  }

  /// A source of the light tree: a light, or a patch (one or two triangles) of an area light.
  struct Source {
    std::uint32_t light = 0;         ///< light index, below count()
    std::uint32_t patch = kNoIndex;  ///< patch of an area light, or kNoIndex
    float per_area = 0.0f;           ///< 1 / area of the patch, in square units
  };
  [[nodiscard]] std::size_t source_count() const { return sources_.size(); }
  [[nodiscard]] const Source& source(std::size_t index) const { return sources_[index]; }
  /// Returns the source that a primitive belongs to, or kNoIndex.
  [[nodiscard]] std::uint32_t source_of(std::uint32_t primitive) const {
    return primitive < source_of_primitive_.size() ? source_of_primitive_[primitive] : kNoIndex;
  }
  /// Returns the source of the environment, which is the last one.
  [[nodiscard]] std::uint32_t environment_source() const {
    return static_cast<std::uint32_t>(sources_.size() - 1);
  }

  [[nodiscard]] bool any_power() const { return any_power_; }
  /// Samples a source for a surface point and its unit normal (LightTree). Requires any_power().
  template <class T>
  [[nodiscard]] RAYGATE_INLINE LightTree::Sample sample_source(const glm::vec3& point,
                                                               const glm::vec3& normal,
                                                               double u) const {
    if (sources_.size() == 1) return {0, 1.0f};
    return tree_.sample<T>(point * per_unit_, normal, u);
  }
  /// Returns the probability that sample_source() chooses a source.
  template <class T>
  [[nodiscard]] RAYGATE_INLINE float pmf(std::uint32_t source, const glm::vec3& point,
                                         const glm::vec3& normal) const {
    if (sources_.size() == 1) return 1.0f;
    return tree_.pmf<T>(source, point * per_unit_, normal);
  }

 private:
  /// A part of an area light: a triangle, or two that form a parallelogram.
  struct Patch {
    glm::vec3 corner{0.0f}, u{0.0f}, v{0.0f}, normal{0.0f};
    /// The triangles on the u side and on the v side of a parallelogram's diagonal.
    std::uint32_t primitive = 0, primitive_beyond = 0;
    float begin = 0.0f, end = 0.0f;  ///< its interval of the light's cumulative area, in [0, 1]
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
  glm::dvec3 ambient_{0.0};
  std::vector<AreaLight> areas_;
  std::vector<Light> lights_;
  std::vector<Patch> patches_;
  std::vector<Source> sources_;                     // by light and patch
  std::vector<std::uint32_t> source_of_primitive_;  // or kNoIndex; instances never emit
  LightTree tree_;
  bool any_power_ = false;
  float per_unit_ = 1.0f;
};

}  // namespace raygate
