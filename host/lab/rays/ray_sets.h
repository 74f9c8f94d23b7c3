// The rays that `lab rays` traces: of a picture, towards a point light, and scattered.
#pragma once

#include "host/lab/rays/peer.h"

namespace raygate::lab {

/// The camera's rays through the centres of size x size pixels, the whole scene in view: tiles of
/// 128 x 128 pixels, in them squares of 8 x 8, in them blocks of 4 x 2, as the renderer has them.
[[nodiscard]] RaySet camera_rays(const Scene& scene, int size);

/// From a point light, above the eye and to its right, towards each of the points that `camera`
/// hit, ending just before it: does anything lie between?
[[nodiscard]] RaySet light_rays(const Scene& scene, const RaySet& camera, const Found& found);

/// From just before each of those points, in random directions on the side of `camera`'s ray:
/// origins of their own, directions as of diffuse light.
[[nodiscard]] RaySet scattered_rays(const Scene& scene, const RaySet& camera, const Found& found);

}  // namespace raygate::lab
