#include "host/tree/box_query.h"

#include "host/tree/walk.h"

namespace raygate {
namespace {

/// A box on its way through the tree.
struct BoxVisitor {
  glm::vec3 low, high;

  [[nodiscard]] static bool goes_on(float, Whole) { return true; }
  [[nodiscard]] static Whole rays_at(int) { return {}; }
  [[nodiscard]] LaneMask meet(const Bvh::Node& node, Whole, FloatLanes& entry) const {
    IntLanes touches = IntLanes{} - 1;
    for (int k = 0; k < 3; ++k) {
      FloatLanes lows, highs;
      load_lanes(node.bounds[0][k], lows);
      load_lanes(node.bounds[1][k], highs);
      touches &= (lows <= high[k]) & (highs >= low[k]);
    }
    entry = FloatLanes{};
    return sign_mask(touches);
  }
  [[nodiscard]] bool touches(const Bvh::Corners& t) const {
    return glm::all(glm::lessThanEqual(glm::min(glm::min(t[0], t[1]), t[2]), high)) &&
           glm::all(glm::lessThanEqual(low, glm::max(glm::max(t[0], t[1]), t[2])));
  }
};

}  // namespace

void leaves_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                 std::vector<Bvh::Child>& leaves) {
  in_vectors([&](auto) RAYGATE_BODY {
    leaves.clear();
    BoxVisitor visitor{low, high};
    WalkStack<Whole> stack({});
    Waiting<Whole> leaf;
    while (next_leaf(bvh, visitor, stack, leaf)) leaves.push_back(leaf.child);
  });
}

void slots_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                std::vector<std::uint32_t>& slots) {
  in_vectors([&](auto) RAYGATE_BODY {
    slots.clear();
    BoxVisitor visitor{low, high};
    WalkStack<Whole> stack({});
    Waiting<Whole> leaf;
    while (next_leaf(bvh, visitor, stack, leaf)) {
      for (std::uint32_t i = 0; i < leaf.child.count; ++i) {
        const std::uint32_t slot = leaf.child.first + i;
        if (visitor.touches(bvh.corners_of(slot))) slots.push_back(slot);
      }
    }
  });
}

}  // namespace raygate
