// Default views of whole scenes, and a ground plane, for images without a camera.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace raygate {

/// Direction from which a scene is seen, in degrees. The front faces +z or, if z is up, -y.
struct View {
  double azimuth = 0.0;          ///< 0 from the front, 90 from the right, counter-clockwise
  double elevation = 0.0;        ///< 0 level, 90 from straight above
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< up direction of the scene; not zero
};

/// The default view, which suits most models: from the front right and above.
inline constexpr double kDefaultAzimuth = 33.0, kDefaultElevation = 24.0;

/// Returns a camera, in the scene's coordinates, that shows all of `scene` from one side, with a
/// margin of 4 %; the target is the centre of its box. `aspect`: the image's width over its height.
/// Throws InputError for a scene without triangles or one too large for float.
[[nodiscard]] CameraSetting frame_scene(const Scene& scene, double aspect, double fov,
                                        const View& view);

/// Returns a camera that shows the scene's bounding box from the front: level for tall scenes, from
/// higher up for flatter scenes. +y is up.
[[nodiscard]] Camera front_camera(const Scene& scene, double aspect);

/// Adds a square of two triangles slightly below the scene's lowest point, 32 times the scene's
/// size, with an object and a shadow-catcher material (illum 10) named "ground". `up` is not zero.
/// Leaves the scene unchanged if a corner of the ground would be beyond kMostCoordinate.
void add_ground(Scene& scene, const glm::dvec3& up);

}  // namespace raygate
