// The integrator: shades the hits of a batch of rays; the light that arrives, and the rays that go
// on.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/light/hits.h"
#include "host/light/integrator_settings.h"
#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/prepared_scene.h"
#include "host/light/ray_batch.h"
#include "host/light/shade.h"
#include "host/light/spawn_ray.h"

namespace raygate {

/// Shades the hits of batches. Not for use by two threads at once.
///
/// Hits of one kind are shaded together, as many at a time as the machine has lanes; where each
/// goes, and in which order lights and rays are added to their lists, follows from the order of the
/// batch alone. So what a sample gets depends on nothing but its own rays.
class Integrator {
 public:
  /// The references must outlive this.
  /// `kind` may differ from the settings' (kLight, kEmitters). `light_paths`: what kPath and kLight
  /// are combined with, or null.
  Integrator(IntegratorKind kind, const PreparedScene& prepared, const Lights& lights,
             const IntegratorSettings& settings, const LightPaths* light_paths = nullptr);
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// So many rays are shaded at a time, at most.
  [[nodiscard]] std::size_t block_size() const { return block_size_; }

  /// Adds what the hits begin .. end of the batch give, at most block_size() of them.
  void shade(const RayBatch& batch, std::span<const NearestHit> hits, std::size_t begin,
             std::size_t end, ShadingOutput& output);

  /// Radiance along rays that hit nothing.
  [[nodiscard]] glm::vec3 background() const {
    return sees_background() ? shading_.lights.background() : glm::vec3(0.0f);
  }
  /// Whether they see an environment instead, at that depth.
  [[nodiscard]] bool sees_environment(int depth) const {
    const Lights& lights = shading_.lights;
    return sees_background() && lights.environment() != nullptr &&
           (depth > 0 || !lights.has_studio());
  }
  /// Whether shadows are cast as if glass did not bend light.
  [[nodiscard]] bool shadows_through_refraction() const { return !is_path(); }

  [[nodiscard]] const SkipCounters& skipped() const { return block_.skipped; }
  /// Hits whose P the host found.
  [[nodiscard]] std::uint64_t point_doubts() const { return point_doubts_; }

 private:
  [[nodiscard]] bool is_path() const {
    return kind_ == IntegratorKind::kPath || kind_ == IntegratorKind::kLight;
  }
  [[nodiscard]] bool sees_background() const {
    return kind_ == IntegratorKind::kWhitted || kind_ == IntegratorKind::kPath;
  }
  void sort(std::span<const NearestHit> hits, std::size_t count, ShadingOutput& output);
  void note_first_surface(std::size_t i, const NearestHit& hit, ShadingOutput& output);
  void add_infinite_light(ShadingOutput& output);
  void list_spawn_queries(std::size_t i);
  [[nodiscard]] bool leaves(const SurfaceHit& place, ScatteredRay& scattered) const;
  void hand_on(std::size_t i, const SpawnOrigin*& origins, ShadingOutput& output);

  IntegratorKind kind_;
  ShadingScene shading_;
  RaySpawner spawner_;
  std::uint64_t point_doubts_ = 0;
  std::size_t block_size_;
  std::span<const MaterialParameters> materials_;
  bool has_masks_;
  const MaterialParameters hole_ = MaterialParameters::hole();
  HitBlock block_;
  std::uint8_t scattered_count_;           // of a hit without caustic rays
  std::vector<SpawnQuery> spawn_queries_;  // of the block's hits, in their order
  std::vector<SpawnOrigin> origins_;
  std::vector<HitKind> kinds_;          // by place in the block; kHitKinds: nothing is hit
  std::vector<std::uint32_t> order_;    // places, kind by kind
  std::vector<std::uint32_t> first_;    // of each kind in it
  std::vector<std::uint32_t> escaped_;  // places of rays that hit nothing but the environment
};

}  // namespace raygate
