// What is near: the triangles whose boxes touch a given box.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "host/tree/bvh.h"

namespace raygate {

/// Replaces `leaves` by all leaves of the tree whose boxes touch the closed box from `low` to
/// `high`, in no particular order.
void leaves_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                 std::vector<Bvh::Child>& leaves);

/// Replaces `slots` by the slots of all triangles whose axis-aligned boxes touch that box.
void slots_near(const Bvh& bvh, const glm::vec3& low, const glm::vec3& high,
                std::vector<std::uint32_t>& slots);

}  // namespace raygate
