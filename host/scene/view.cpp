#include "host/scene/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/base/elementary.h"
#include "host/base/input_error.h"
#include "host/scene/bounds.h"

namespace raygate {
namespace {

Bounds3 bounding_box(const Scene& scene) {
  if (is_empty(scene)) throw InputError("cannot frame a scene without faces");
  return triangle_bounds(scene);
}

/// The right-handed unit axes of a scene with up direction `upwards`.
struct Axes {
  glm::dvec3 up, front, right;

  explicit Axes(const glm::dvec3& upwards) {
    up = unit(upwards);
    const glm::dvec3 near = std::abs(up.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
    front = glm::normalize(near - glm::dot(near, up) * up);
    right = glm::cross(up, front);
  }

  /// Returns the direction with these angles in degrees, as in View.
  [[nodiscard]] glm::dvec3 direction(double azimuth, double elevation) const {
    const SineCosine<double> turned = sine_cosine(azimuth / 360.0);
    const SineCosine<double> raised = sine_cosine(elevation / 360.0);
    return raised.cosine * (turned.cosine * front + turned.sine * right) + raised.sine * up;
  }
};

/// Returns the camera of `view` whose image the points just fill. for_each_point(visit) visits the
/// points, relative to the middle of `box`.
template <class ForEachPoint>
CameraSetting frame(const Bounds3& box, double aspect, double fov, const View& view,
                    const ForEachPoint& for_each_point) {
  const glm::dvec3 centre = box.middle(), half = box.half_size();
  const Axes axes(view.up);
  const glm::dvec3 towards_eye = axes.direction(view.azimuth, view.elevation);
  constexpr double kSteep = 89.0;  // up is (almost) parallel to the view
  const glm::dvec3 up = std::abs(view.elevation) < kSteep
                            ? axes.up
                            : axes.direction(view.azimuth, view.elevation + 90.0);
  const double size = std::max({half.x, half.y, half.z});
  const Camera at_centre = Camera::look_at({centre + towards_eye * size, centre, up, fov}, aspect);

  // The smallest distance at which all points are within the four sides of the view frustum.
  constexpr double kFilled = 0.96;
  const double half_height = at_centre.half_height(), half_width = half_height * aspect;
  double distance = 0.0;
  for_each_point([&](const glm::dvec3& offset) {
    const double nearer = -glm::dot(offset, at_centre.forward());
    const double across = std::abs(glm::dot(offset, at_centre.right())) / half_width;
    const double upwards = std::abs(glm::dot(offset, at_centre.up())) / half_height;
    distance = std::max(distance, std::max(across, upwards) / kFilled + nearer);
  });
  return {centre + distance * towards_eye, centre, up, fov};
}

}  // namespace

CameraSetting frame_scene(const Scene& scene, double aspect, double fov, const View& view) {
  const Bounds3 box = bounding_box(scene);
  return frame(box, aspect, fov, view, [&](const auto& show) {
    for_each_face(scene, [&](const Corners& triangle, const Triangle&) {
      for (const glm::dvec3& corner : triangle) show(corner - box.middle());
    });
  });
}

Camera front_camera(const Scene& scene, double aspect) {
  const Bounds3 box = bounding_box(scene);
  const glm::dvec3 half = box.half_size();
  const View view{0.0, 3.0 + 27.0 * (1.0 - std::min(1.0, half.y / std::max(half.x, half.z)))};
  const auto for_each_corner = [&](const auto& show) {
    for (int corner = 0; corner < 8; ++corner) {
      show(half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    }
  };
  return Camera::look_at(frame(box, aspect, Camera::kDefaultFov, view, for_each_corner), aspect);
}

void add_ground(Scene& scene, const glm::dvec3& up) {
  if (is_empty(scene)) return;
  const glm::dvec3 upright = unit(up);
  const Bounds3 box = position_bounds(scene);
  double lowest = std::numeric_limits<double>::infinity();
  const auto show = [&](const glm::vec3& position) {
    lowest = std::min(lowest, glm::dot(glm::dvec3(position), upright));
  };
  std::ranges::for_each(scene.positions, show);
  for (const Instance& instance : scene.instances) {
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
      show(transform_point(instance.rows, position));
    }
  }
  // The ground is slightly below the lowest point, so that a floor of the scene hides it.
  constexpr double kBelow = 0x1p-11, kHalfSide = 16.0;
  const double size = glm::length(box.high - box.low);
  const glm::dvec3 middle = box.middle();
  const glm::dvec3 centre = middle + (lowest - kBelow * size - glm::dot(middle, upright)) * upright;
  const glm::dvec3 across = std::abs(upright.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 v = kHalfSide * size * glm::normalize(glm::cross(across, upright));
  const glm::dvec3 u = glm::cross(v, upright);
  const std::array<glm::vec3, 4> corners{centre + (-u - v), centre + (u - v), centre + (u + v),
                                         centre + (v - u)};
  for (const glm::vec3& corner : corners) {
    if (!(largest(corner) <= kMostCoordinate)) return;
  }
  Material material;
  material.name = "ground";
  material.illumination_model = 10;
  add_quad(scene, corners, material);
}

}  // namespace raygate
