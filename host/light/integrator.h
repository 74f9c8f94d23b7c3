// Integrator: shades the hits of a batch of rays and spawns shadow rays and scattered rays.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/light/hits.h"
#include "host/light/prepared_scene.h"
#include "host/light/spawn_ray.h"

namespace raygate {

/// Shades the hits of batches. Hits of one HitKind are shaded together. Not thread-safe. The order
/// of results depends only on the batch's order, and a sample's radiance only on its own rays.
class Integrator {
 public:
  /// The references must outlive this object. `kind` may differ from `settings.integrator` (kLight,
  /// kEmitters). `light_paths`: null if only camera paths find light; not null for kLight.
  Integrator(IntegratorKind kind, const PreparedScene& prepared, const Lights& lights,
             const IntegratorSettings& settings, const LightPaths* light_paths = nullptr);
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Returns the maximum number of rays per call of shade().
  [[nodiscard]] std::size_t block_size() const { return block_size_; }

  /// Shades hits [begin, end) of the batch, at most block_size(), and adds the results to `output`.
  void shade(const RayBatch& batch, std::span<const NearestHit> hits, std::size_t begin,
             std::size_t end, ShadingOutput& output);

  /// Returns the constant radiance along rays that miss all geometry, unless sees_environment().
  [[nodiscard]] glm::vec3 background() const {
    return sees_background() ? shading_.lights.background() : glm::vec3(0.0f);
  }
  /// Returns whether rays that miss all geometry see an environment instead of background().
  [[nodiscard]] bool sees_environment() const {
    return sees_background() && shading_.lights.environment() != nullptr;
  }

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
  void output_hit(std::size_t i, ShadingOutput& output);

  IntegratorKind kind_;
  ShadingScene shading_;
  RaySpawner spawner_;
  std::size_t block_size_;
  std::span<const MaterialParameters> materials_;
  bool has_masks_;
  const MaterialParameters hole_ = MaterialParameters::hole();
  HitBlock block_;
  std::vector<SpawnQuery> spawn_queries_;               // of the block's hits
  std::vector<std::array<std::uint32_t, 2>> query_at_;  // by position and side: index of the query
  std::vector<SpawnOrigin> origins_;
  std::vector<HitKind> kinds_;          // by position in the block; kHitKinds: no hit
  std::vector<std::uint32_t> order_;    // positions, sorted by kind
  std::vector<std::uint32_t> first_;    // index in order_ of each kind's first position
  std::vector<std::uint32_t> escaped_;  // positions of rays that see the environment
};

}  // namespace raygate
