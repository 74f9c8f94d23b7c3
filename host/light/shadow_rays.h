// Shadow rays: how much of a light reaches a surface.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator_settings.h"
#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/prepared_scene.h"
#include "host/light/spawn_ray.h"
#include "host/light/surface.h"
#include "host/scene/scene.h"

namespace raygate {

/// A query: how much of `radiance` arrives?
struct ShadowRay {
  static constexpr std::uint32_t kNoPoint = NearestHit::kNone;

  std::uint32_t sample = 0;  ///< whose light it is: for the caller
  glm::vec3 radiance{0.0f};  ///< what arrives if nothing is between; what does arrive
  glm::vec3 surface{0.0f};   ///< origin of the ray, from RaySpawner
  std::uint32_t surface_primitive = 0;
  std::uint32_t point_light = kNoPoint;  ///< index; or else the light is an area's or far away:
  glm::vec3 target{0.0f};                ///< its point, or the direction towards it
  std::uint32_t target_primitive = 0;    ///< and what that is on; kNone: it is infinitely far away
  bool is_to_camera = false;             ///< the target is a point that is on nothing
};

/// Traces shadow rays in batches.
///
/// Rays of a point light begin at the light, where they share its records, and end at the surface.
/// Rounding their direction moves that end by about a float; so a hit in the last 2^-10 of the way
/// does not count by itself: such a ray is traced again, from the surface. Hits of the surface's
/// own triangle do not count, for the departure point is on the light's side of it. Where there are
/// so many point lights that hardly any has several rays, all begin at the surface. Rays of area
/// lights begin at the surface and end 2^-16 of the way before the light, whose own triangle does
/// not count. Rays to lights that are infinitely far away begin at the surface and have no end.
/// Surfaces that let light through straight weaken it.
class ShadowRays {
 public:
  /// `through_refraction`: glass that bends light casts the shadow of one that does not.
  ShadowRays(const PreparedScene& prepared, const Lights& lights, Intersector& intersector,
             const Skips& skips, bool through_refraction);

  /// Called for each ray that was traced with what its search took, by its shadow ray's index.
  using TracedFunction = std::function<void(const RayWork& work, std::size_t shadow_ray)>;

  /// Multiplies each ray's `radiance` by what is not held up on its way: all, nothing, or what
  /// clear surfaces leave. `traced` may be empty.
  void resolve(std::span<ShadowRay> rays, const TracedFunction& traced = {});

  [[nodiscard]] std::uint64_t rays() const { return rays_; }  ///< traced so far

 private:
  /// A ray of the next batch.
  struct Segment {
    std::uint32_t index;  // of the shadow ray that it is a part of
    glm::vec3 from, to;
    std::uint32_t source;   // the primitive that it begins at, if it begins at one
    std::uint32_t ignored;  // primitive
    float share;            // of the way in which hits count; infinite: `to` is a direction
  };

  void trace_from_light(std::span<ShadowRay> rays, std::uint32_t point_light);
  void trace_from_surface(std::span<ShadowRay> rays);
  void trace(bool from_light, float enough);
  void next_from_surface(const ShadowRay& ray, std::uint32_t index);
  /// Where ray `number` of the batch hits a primitive.
  [[nodiscard]] SurfaceHit place_of(std::size_t number, std::uint32_t primitive) const;
  /// Whether no light comes through there, nor near by.
  [[nodiscard]] bool ends_at(std::size_t number, std::uint32_t primitive) const;
  /// What is left after the surface that ray `number` of the batch has hit.
  [[nodiscard]] glm::vec3 transmittance(std::size_t number) const;

  const Scene& scene_;
  std::span<const MaterialParameters> materials_;
  const Bvh& bvh_;
  const Lights& lights_;
  Intersector& intersector_;
  RaySpawner spawner_;
  std::vector<SpawnQuery> spawn_queries_;  // beyond clear surfaces, and their answers
  std::vector<SpawnOrigin> origins_;
  bool first_occluder_, culling_, through_refraction_, any_clear_;
  std::uint64_t rays_ = 0;
  // Room to work in.
  std::vector<Segment> segments_, next_;
  std::vector<Ray> batch_;
  std::vector<NearestHit> hits_;
  std::vector<RayWork> work_;
  std::vector<float> limits_, enough_;
  std::vector<std::uint32_t> ignored_, sources_;
  const TracedFunction* traced_ = nullptr;
};

// Why a sure occluder leaves a shadow dark
//
// A shadow ray that meets holes of masks, or what lets light through, goes on from behind each as
// a ray of its own, from an origin O' that rounding and RaySpawner have moved. Let S be the largest
// coordinate of its beginning O and of the hit X. ShadowRays lets no O' be farther than 2^-16 S
// from the first ray's line (strays_from); the rays' directions are rounded by 2^-24 of themselves,
// which moves them by less than 2^-22 S where X is. So seen along the first ray, all of them pass
// within kRoom S = 2^-15 S of X. Where no edge of X's triangle is so near, each hits the triangle,
// if it comes so far: RaySpawner puts no origin on the wrong side of a triangle. There is nothing
// to see through within this distance: the last of them ends there, if none has ended before.

/// Whether an opaque surface is hit so far within it. `place` is a sure hit of a ray; hits count up
/// to t_max (+infinity: no limit). The triangle's material is opaque but for its mask.
[[nodiscard]] bool is_sure_occluder(const Scene& scene, const Bvh& bvh, const SurfaceHit& place,
                                    float t_max);

/// Whether a point is too far from the line through `from` along `way`, for this to hold.
[[nodiscard]] bool strays_from(const glm::vec3& from, const glm::dvec3& way,
                               const glm::vec3& point);

}  // namespace raygate
