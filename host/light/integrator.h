// How a picture follows from hits: what becomes of light where a ray meets a surface.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/light/hits.h"
#include "host/light/integrator_kind.h"
#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/path_options.h"
#include "host/light/point_error.h"
#include "host/light/ray_batch.h"
#include "host/light/skips.h"
#include "host/light/spawn_ray.h"

namespace raygate {

struct IntegratorOptions {
  int max_depth = 4;                ///< rays of this depth are the last
  double threshold = 1.0 / 256.0;   ///< Whitted: rays that count for less are not traced
  glm::dvec3 ambient{0.0};          ///< Whitted: radiance from all sides that reaches everything
  bool single_sample = false;       ///< one sample a pixel: no chance where there is a middle
  PathOptions path{};               ///< path
  float point_error = kPointError;  ///< the host finds P where the unit's is off by more of itself
};

/// Shades the hits of batches. Not for use by two threads at once.
///
/// Hits of one kind are shaded together, as many at a time as the machine has lanes; where each
/// goes, and in which order lights and rays are added to their lists, follows from the order of the
/// batch alone. So what a sample gets depends on nothing but its own rays.
class Integrator {
 public:
  /// `each`: of a hit, so many light samples and scattered rays, at most. The references must
  /// outlive this.
  Integrator(const Scene& scene, const NeighborClearances& clearances, const Lights& lights,
             const Skips& skips, const IntegratorOptions& options,
             std::size_t light_samples_per_hit, std::size_t scattered_per_hit);
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// So many rays are shaded at a time, at most.
  [[nodiscard]] std::size_t block_size() const { return block_size_; }

  /// Adds what the hits begin .. end of the batch give, at most block_size() of them.
  void shade(const RayBatch& batch, std::span<const NearestHit> hits, std::size_t begin,
             std::size_t end, ShadingOutput& output);

  /// Radiance along rays that hit nothing.
  [[nodiscard]] virtual glm::vec3 background() const { return shading_.lights.background(); }
  /// Whether they see an environment instead.
  [[nodiscard]] bool sees_environment() const {
    return shading_.sees_environment && shading_.lights.environment() != nullptr;
  }
  /// Whether shadows are cast as if glass did not bend light.
  [[nodiscard]] virtual bool shadows_through_refraction() const { return true; }

  [[nodiscard]] const SkipCounters& skipped() const { return skipped_; }
  /// Hits whose P the host found.
  [[nodiscard]] std::uint64_t point_doubts() const { return point_doubts_; }

 protected:
  /// Shades hits of one kind: those at `at` in the block.
  virtual void shade_kind(HitBlock& block, HitKind kind, std::span<const std::uint32_t> at) = 0;

  ShadingScene shading_;
  SkipCounters skipped_;

 private:
  void sort(std::span<const NearestHit> hits, std::size_t count, ShadingOutput& output);
  void list_spawn_queries(std::size_t i);
  [[nodiscard]] bool leaves(const SurfaceHit& place, ScatteredRay& scattered) const;
  void hand_on(std::size_t i, const SpawnOrigin*& origins, ShadingOutput& output);

  RaySpawner spawner_;
  Skips skips_;
  float point_error_;
  std::uint64_t point_doubts_ = 0;
  std::size_t block_size_;
  std::vector<MaterialParameters> materials_;  // of the materials
  const MaterialParameters transparent_ = MaterialParameters::transparent();
  HitBlock block_;
  std::vector<SpawnQuery> spawn_queries_;  // of the block's hits, in their order
  std::vector<SpawnOrigin> origins_;
  std::vector<HitKind> kinds_;          // by place in the block; kHitKinds: nothing is hit
  std::vector<std::uint32_t> order_;    // places, kind by kind
  std::vector<std::uint32_t> first_;    // of each kind in it
  std::vector<std::uint32_t> escaped_;  // places of rays that hit nothing but the environment
};

[[nodiscard]] std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, const Scene& scene,
                                                          const NeighborClearances& clearances,
                                                          const Lights& lights, const Skips& skips,
                                                          const IntegratorOptions& options);

}  // namespace raygate
