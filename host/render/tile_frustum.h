// Tile frustum: whether any box of the tree is within what a tile of the picture sees.
#pragma once

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/scene/camera.h"

namespace raygate {

/// Whether a ray through `tile`, or up to `margin` pixels beside it, may come near a leaf of the
/// tree. False only where surely none does, whatever is rounded on the way.
[[nodiscard]] bool may_see_anything(const Bvh& bvh, const Camera& camera, const Film& film,
                                    const PixelRect& tile, double margin);

/// The same of a ray that may meet the box from `low` to `high`.
[[nodiscard]] bool may_see_box(const glm::vec3& low, const glm::vec3& high, const Camera& camera,
                               const Film& film, const PixelRect& tile, double margin);

}  // namespace raygate
