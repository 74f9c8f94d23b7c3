// A mesh's tree where an instance puts it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// Its nodes and primitives are those of the mesh's tree, of numbers from `first_node` and
/// `first_primitive` on.
struct InstanceBvh {
  double rows[3][4];      ///< as Instance has them
  float matrix[3][3];     ///< the first three of each
  float low[3], high[3];  ///< about the fourth: what bounds begin with
  std::uint32_t mesh;     ///< whose tree it is
  std::uint32_t first_node = 0, first_primitive = 0;
  std::uint32_t first_triangle = 0;  ///< in the scene

  /// `size`: the largest magnitudes of the bounds of the mesh's tree.
  InstanceBvh(const Instance& instance, const glm::dvec3& size);
};

}  // namespace raygate
