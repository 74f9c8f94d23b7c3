// Where a camera is in each frame of a film.
#pragma once

#include <vector>

#include "host/scene/camera.h"

namespace raygate {

/// The camera at `time`, from 0 (the first place of `path`) to 1 (the last one): a smooth way
/// through all places (Catmull-Rom), which takes the same time from each place to the next. Fields
/// of view and upward directions are those of the two places around it, in proportion; one that a
/// place leaves out is `default_fov`, or +y. `path` has at least two places.
[[nodiscard]] CameraSetting camera_at(const std::vector<CameraSetting>& path, double time,
                                      double default_fov);

/// `camera` after `turn` (1 is all the way round) around the vertical axis through its target,
/// counter-clockwise seen from above. Vertical is the coordinate axis nearest to its up, or y.
[[nodiscard]] CameraSetting orbited(const CameraSetting& camera, double turn);

}  // namespace raygate
