#include "host/tree/box_query.h"

namespace raygate {
namespace {

bool overlap(const glm::vec3& low, const glm::vec3& high, const glm::vec3& other_low,
             const glm::vec3& other_high) {
  return glm::all(glm::lessThanEqual(low, other_high)) &&
         glm::all(glm::lessThanEqual(other_low, high));
}

}  // namespace

void slots_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                std::vector<std::uint32_t>& slots) {
  slots.clear();
  Bvh::Ref waiting[Bvh::kMaxDepth + 2];
  int depth = 0;
  waiting[depth++] = bvh.root();
  while (depth > 0) {
    const Bvh::Ref ref = waiting[--depth];
    if (ref.count == 0) {
      const Bvh::Node& node = bvh.nodes()[ref.first];
      for (int side = 0; side < 2; ++side) {
        if (overlap(low, high, node.bounds[0][side], node.bounds[1][side])) {
          waiting[depth++] = node.child[side];
        }
      }
      continue;
    }
    for (std::uint32_t slot = ref.first; slot < ref.first + ref.count; ++slot) {
      const Bvh::Corners& t = bvh.corners_of(slot);
      if (overlap(low, high, glm::min(glm::min(t[0], t[1]), t[2]),
                  glm::max(glm::max(t[0], t[1]), t[2]))) {
        slots.push_back(slot);
      }
    }
  }
}

}  // namespace raygate
