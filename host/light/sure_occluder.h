// Sure occluder: a hit that holds up all light, whatever rounding does to the rays.
#pragma once

#include <glm/glm.hpp>

#include "host/bvh/bvh.h"
#include "host/light/surface.h"
#include "host/scene/scene.h"

// Why a sure occluder leaves a shadow dark
//
// A shadow ray that meets holes of masks, or what lets light through, goes on from behind each as
// a ray of its own, from an origin O' that rounding and RaySpawner have moved. Let S be the largest
// coordinate of its beginning O and of the hit X. ShadowRays lets no O' be farther than 2^-16 S
// from the first ray's line (strays_from); the rays' directions are rounded by 2^-24 of themselves,
// which moves them by less than 2^-22 S where X is. So seen along the first ray, all of them pass
// within kRoom S = 2^-15 S of X. Where no edge of X's triangle is so near, each hits the triangle,
// if it comes so far: RaySpawner puts no origin on the wrong side of a triangle. There is nothing
// to see through within this distance: the last of them ends there, if none has ended before.

namespace raygate {

/// Whether an opaque surface is hit so far within it. `place` is a sure hit of a ray; hits count up
/// to t_max (+infinity: no limit). The triangle's material is opaque but for its mask.
[[nodiscard]] bool is_sure_occluder(const Scene& scene, const Bvh& bvh, const SurfaceHit& place,
                                    float t_max);

/// Whether a point is too far from the line through `from` along `way`, for this to hold.
[[nodiscard]] bool strays_from(const glm::vec3& from, const glm::dvec3& way,
                               const glm::vec3& point);

}  // namespace raygate
