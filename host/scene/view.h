// The view of a whole scene, and the ground below it, for a picture that names no camera.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace raygate {

/// From which side a scene is seen, in degrees. The front is towards +z; where z is up, towards -y,
/// as modellers have it.
struct View {
  double azimuth = 0.0;          ///< 0 from the front, 90 from the right, counter-clockwise
  double elevation = 0.0;        ///< 0 level, 90 from straight above
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< upwards in the scene; not zero
};

/// A view that shows what most models are: from the right of the front and from above.
inline constexpr double kDefaultAzimuth = 33.0, kDefaultElevation = 24.0;

/// From the front: level for a tall scene (or the inside of a box), the higher the flatter it is.
[[nodiscard]] View front_view(const Scene& scene, const glm::dvec3& up = {0.0, 1.0, 0.0});

/// Whether most faces look inwards: the inside of a box, whose floor and walls are there.
[[nodiscard]] bool is_interior(const Scene& scene);

/// The view of a first look: kDefaultAzimuth and kDefaultElevation, or another side where that
/// looks along the edges of a flat model; or front_view() of a room, whose walls would be in the
/// way.
[[nodiscard]] View default_view(const Scene& scene, const glm::dvec3& up);

/// +y or +z: the file's format says which (Scene::up), or it is what is usual there, but where the
/// scene would then fall over and stands the other way, or lies clearly flatter on that end. What
/// lies in one plane of the axes is as usual.
[[nodiscard]] glm::dvec3 guess_up_axis(const Scene& scene);

/// The part of a scene that fills the picture.
enum class FrameFit {
  kVertices,  ///< the vertices of the scene
  kBox,       ///< their bounding box
};

/// A camera that shows all of `scene` from one side, in the scene's coordinates: `filling` fills
/// the picture but for a margin of 4 %, and the box's middle is the target. `aspect` is width /
/// height of the picture. Throws InputError for a scene without triangles or one too large for
/// float.
[[nodiscard]] CameraSetting frame_scene(const Scene& scene, double aspect, double fov,
                                        const View& view, FrameFit filling = FrameFit::kVertices);

/// A camera of front_view(): all of the scene's box in the picture.
[[nodiscard]] Camera front_camera(const Scene& scene, double aspect,
                                  double fov = Camera::kDefaultFov);

/// Adds a square of two triangles under the scene, a hair below its lowest point and 32 times its
/// size, of an object and a material of its own, "ground": it catches shadows (illum 10) and is
/// else not to be seen. `up` is not zero. A scene too large for that is left as it is.
void add_ground(Scene& scene, const glm::dvec3& up);

}  // namespace raygate
