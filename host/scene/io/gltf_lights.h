// The lights of a glTF file (KHR_lights_punctual).
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/scene.h"

namespace raygate {

/// Turns the lights of nodes into those of a scene; watts a steradian for candelas.
class GltfLights {
 public:
  /// Both must outlive this.
  GltfLights(const GltfFile& file, Scene& scene) : file_(file), scene_(scene) {}

  /// The light of a node that is at `world`. Warns and leaves out one without a direction. Throws
  /// InputError: a negative or infinite intensity, impossible angles.
  void add(const tinygltf::Light& light, const glm::dmat4& world);

  /// Gives the scene the lights that have a place, when its origin is known. Throws InputError: a
  /// light beyond the range of float.
  void place();

 private:
  /// A light of a point, where its node puts it.
  struct PlacedLight {
    glm::dvec3 position;
    glm::dvec3 intensity;
    std::optional<SpotCone> spot;
  };

  const GltfFile& file_;
  Scene& scene_;
  std::vector<PlacedLight> lights_;
};

}  // namespace raygate
