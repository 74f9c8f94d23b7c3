#include "host/tree/box_query.h"

namespace raygate {

void slots_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                std::vector<std::uint32_t>& slots) {
  slots.clear();
  in_vectors([&](auto code) RAYGATE_BODY {
    for_leaves_near<code()>(bvh, low, high, [&](const Bvh::Child& leaf) RAYGATE_BODY {
      for (std::uint32_t slot = leaf.first; slot < leaf.first + leaf.count; ++slot) {
        const Bvh::Corners t = bvh.corners_of(slot);
        if (glm::all(glm::lessThanEqual(glm::min(glm::min(t[0], t[1]), t[2]), high)) &&
            glm::all(glm::lessThanEqual(low, glm::max(glm::max(t[0], t[1]), t[2])))) {
          slots.push_back(slot);
        }
      }
    });
  });
}

}  // namespace raygate
