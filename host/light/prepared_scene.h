// Prepared scene: data shared by all images of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <vector>

#include "host/light/lights.h"
#include "host/light/material_parameters.h"
#include "host/light/spawn_ray.h"

namespace raygate {

/// Read-only data shared by all threads, for any camera and its lights.
struct PreparedScene {
  /// The references must outlive this object. `tree` must be the scene's BVH.
  PreparedScene(const Scene& loaded, const Bvh& tree)
      : scene(loaded),
        bvh(tree),
        clearances(tree),
        materials(loaded.materials.begin(), loaded.materials.end()) {}

  /// Returns the scene's own lights, created at the first call. Thread-safe.
  [[nodiscard]] const Lights& lights(Lights::Sampling sampling) const {
    const std::lock_guard lock(mutex_);
    auto& lights = lights_[static_cast<std::size_t>(sampling)];
    return lights ? *lights : lights.emplace(scene, bvh, sampling);
  }

  const Scene& scene;
  const Bvh& bvh;
  NeighborClearances clearances;
  std::vector<MaterialParameters> materials;  ///< by index in Scene::materials

 private:
  mutable std::mutex mutex_;
  mutable std::array<std::optional<Lights>, 2> lights_;  // by Lights::Sampling
};

}  // namespace raygate
