// What is near: the triangles whose boxes touch a given box.
#pragma once

#include <bit>
#include <glm/glm.hpp>
#include <vector>

#include "host/lanes.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Calls visit(leaf) for all leaves of the tree whose boxes touch the closed box from `low` to
/// `high`, in no particular order. For bodies of in_vectors.
template <Vectors kCode, class Visit>
RAYGATE_INLINE void for_leaves_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                                    const Visit& visit) {
  std::uint32_t waiting[Bvh::kStackSize];
  waiting[0] = 0;
  for (int depth = 1; depth > 0;) {
    const Bvh::Node& node = bvh.nodes()[waiting[--depth]];
    IntLanes touches = IntLanes{} - 1;
    for (int k = 0; k < 3; ++k) {
      FloatLanes lows, highs;
      load_lanes(node.bounds[0][k], lows);
      load_lanes(node.bounds[1][k], highs);
      touches &= (lows <= high[k]) & (highs >= low[k]);
    }
    for (LaneMask met = sign_mask<kCode>(touches); met != 0; met &= met - 1) {
      const Bvh::Child child = node.child[std::countr_zero(met)];
      bvh.prefetch(child);
      if (child.count == 0) {
        waiting[depth++] = child.first;
      } else {
        visit(child);
      }
    }
  }
}

/// Replaces `slots` by the slots of all triangles whose axis-aligned boxes touch that box.
void slots_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                std::vector<std::uint32_t>& slots);

}  // namespace raygate
