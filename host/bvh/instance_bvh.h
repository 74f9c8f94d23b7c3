// A mesh's tree where an instance puts it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// Its nodes and slots are those of the mesh's tree, of numbers from `first_node` and `first_slot`
/// on.
struct PlacedTree {
  double rows[3][4];      ///< as Instance has them
  float matrix[3][3];     ///< the first three of each
  float low[3], high[3];  ///< about the fourth: what bounds begin with
  std::uint32_t mesh;     ///< whose tree it is
  std::uint32_t first_node = 0, first_slot = 0;
  std::uint32_t first_triangle = 0;  ///< in the scene

  /// `size`: the largest magnitudes of the bounds of the mesh's tree.
  PlacedTree(const Instance& instance, const glm::dvec3& size);
};

}  // namespace raygate
