// Parts of a picture in which there is nothing to see.
#pragma once

#include "host/film/film.h"
#include "host/scene/camera.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Whether a ray through `tile`, or up to `margin` pixels beside it, may come near a leaf of the
/// tree. False only where surely none does, whatever is rounded on the way.
[[nodiscard]] bool may_see_anything(const Bvh& bvh, const Camera& camera, const Film& film,
                                    const PixelRect& tile, double margin);

}  // namespace raygate
