// Shadow rays: the fraction of light that reaches a surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/light/lights.h"
#include "host/light/prepared_scene.h"
#include "host/light/spawn_ray.h"

namespace raygate {

/// A light sample of a hit: a shadow ray to trace, and the radiance that it carries.
struct alignas(16) LightSample {
  glm::vec3 radiance{0.0f};  ///< unoccluded radiance; after resolve() the radiance that arrives
  /// A point of an area light or of the lens, or the direction to a distant light.
  glm::vec3 target{0.0f};
  /// Index of a point light, or primitive of the target; kNone: a distant light.
  std::uint32_t index = 0;
  std::uint32_t is_asked : 1 = 0;        ///< the contribution is not 0
  std::uint32_t is_transmitted : 1 = 0;  ///< through rough glass
  std::uint32_t is_point_light : 1 = 0, is_to_camera : 1 = 0;
};

/// A light sample with the origin of its shadow ray.
struct ShadowRay : LightSample {
  std::uint32_t sample = 0;  ///< set by the caller: the sample to which it belongs
  std::uint32_t surface_primitive = 0;
  glm::vec3 surface{0.0f};  ///< origin of the ray, from RaySpawner
};

/// Traces shadow rays in batches.
///
/// Rays of a point light start at the light and share its polygon records. They end at the surface
/// and ignore the surface's own triangle. Rounding the direction moves the end by about one float
/// step. A hit in the last 2^-10 of the distance is therefore not conclusive, and the ray is traced
/// again from the surface. Rays of other lights start at the surface, and so do all rays if there
/// are more than 64 point lights: few of these would have several rays. Rays to area lights end at
/// 1 - 2^-16 of the distance, and the light's own triangle is ignored. Surfaces that transmit light
/// without refraction attenuate it.
class ShadowRays {
 public:
  /// `through_refraction`: refracting glass attenuates shadow rays as if it did not refract.
  /// Otherwise, the glass blocks shadow rays, and caustics light its shadow.
  ShadowRays(const PreparedScene& prepared, const Lights& lights, Intersector& intersector,
             bool through_refraction);

  /// Multiplies each ray's `radiance` by the transmittance along the ray. Adds the ray's work to
  /// work[ShadowRay::sample], unless `work` is empty.
  void resolve(std::span<ShadowRay> rays, std::span<RayWork> work = {});

  [[nodiscard]] std::uint64_t rays() const { return rays_; }  ///< number of rays traced so far

 private:
  /// A ray of the next batch.
  struct Segment {
    // Constructed in place, because copying a temporary is slower.
    Segment(std::uint32_t number, const glm::vec3& origin, std::uint32_t primitive)
        : index(number), source(primitive), from(origin) {}

    std::uint32_t index;   // index of the shadow ray
    std::uint32_t source;  // the primitive at which the segment starts; kNone: a light
    glm::vec3 from;
  };

  void trace_from_light(std::span<ShadowRay> rays, std::uint32_t point_light);
  void trace_from_surface(std::span<ShadowRay> rays);
  void trace(std::span<const ShadowRay> rays, bool from_light, float enough);
  /// Returns the transmittance of the surface that ray `number` of the batch hit.
  [[nodiscard]] glm::vec3 transmittance(std::size_t number) const;

  const Scene& scene_;
  std::span<const MaterialParameters> materials_;
  const Bvh& bvh_;
  const Lights& lights_;
  Intersector& intersector_;
  RaySpawner spawner_;
  std::vector<SpawnQuery> spawn_queries_;  // origins behind transmitting surfaces
  std::vector<SpawnOrigin> origins_;
  bool through_refraction_;
  bool any_clear_;  // some material transmits light or has a mask
  std::uint64_t rays_ = 0;
  // Reused buffers.
  std::vector<Segment> segments_, next_;
  std::vector<Ray> batch_;
  std::vector<NearestHit> hits_;
  std::vector<RayWork> work_;
  std::vector<float> limits_, enough_;
  std::vector<std::uint32_t> ignored_, sources_;
  std::span<RayWork> work_of_samples_;
};

}  // namespace raygate
