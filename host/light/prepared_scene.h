// Prepared scene: what all pictures of a scene share, made once when the scene is loaded.
#pragma once

#include <vector>

#include "host/bvh/bvh.h"
#include "host/light/material_parameters.h"
#include "host/light/neighbor_clearance.h"
#include "host/scene/scene.h"

namespace raygate {

/// For all threads to read, and for any camera and its lights.
struct PreparedScene {
  /// The references must outlive this. `tree` is the scene's.
  PreparedScene(const Scene& loaded, const Bvh& tree)
      : scene(loaded),
        bvh(tree),
        clearances(tree),
        materials(loaded.materials.begin(), loaded.materials.end()) {}

  const Scene& scene;
  const Bvh& bvh;
  NeighborClearances clearances;
  std::vector<MaterialParameters> materials;  ///< of Scene::materials, in their order
};

}  // namespace raygate
