#include "host/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/elementary.h"
#include "host/exact/exact.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

/// The tangent of half an angle in degrees.
double half_tangent(double degrees) {
  const SineCosine<double> half = sine_cosine(degrees / 720.0);
  return half.sine / half.cosine;
}

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Length 1, also where the square of a component would overflow or underflow.
glm::dvec3 unit(const glm::dvec3& v) { return glm::normalize(v / largest(v)); }

std::string text(const glm::dvec3& v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
}

struct Box {
  glm::dvec3 low, high;
};

Box bounding_box(const Scene& scene) {
  if (scene.triangles.empty()) throw InputError("cannot frame a scene without faces");
  const glm::dvec3 first(scene.positions[scene.triangles[0].vertices[0]]);
  Box box{first, first};
  for (const Triangle& triangle : scene.triangles) {
    for (const std::uint32_t vertex : triangle.vertices) {
      const glm::dvec3 position(scene.positions[vertex]);
      box.low = glm::min(box.low, position);
      box.high = glm::max(box.high, position);
    }
  }
  return box;
}

}  // namespace

Camera Camera::look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up,
                       double vertical_fov_degrees, double aspect) {
  if (!is_finite(eye) || !is_finite(target) || !is_finite(up)) {
    throw InputError("camera: eye " + text(eye) + ", target " + text(target) + ", up " + text(up) +
                     ": expected finite numbers");
  }
  if (!(vertical_fov_degrees > 0.0 && vertical_fov_degrees < 180.0)) {
    throw InputError("camera: field of view of " + std::to_string(vertical_fov_degrees) +
                     " degrees: expected more than 0 and less than 180");
  }
  if (!(aspect > 0.0) || !std::isfinite(aspect)) {
    throw InputError("camera: aspect of " + std::to_string(aspect) +
                     ": expected width / height, a positive number");
  }
  const glm::dvec3 view = target - eye;
  if (!is_finite(view)) throw InputError("camera: eye and target are too far apart");
  if (largest(view) == 0.0) {
    throw InputError("camera: eye and target are one point, " + text(eye));
  }
  Camera camera;
  camera.forward_ = unit(view);
  const glm::dvec3 sideways = largest(up) == 0.0 ? up : glm::cross(camera.forward_, unit(up));
  if (glm::length(sideways) < 1e-9) {
    throw InputError("camera: up " + text(up) +
                     " is zero or along the view: expected a direction across it");
  }
  camera.right_ = glm::normalize(sideways);
  camera.up_ = glm::cross(camera.right_, camera.forward_);
  camera.eye_ = glm::vec3(eye);
  if (!is_finite(glm::dvec3(camera.eye_))) {
    throw InputError("camera: eye " + text(eye) + " is beyond the range of float");
  }
  camera.vertical_fov_degrees_ = vertical_fov_degrees;
  camera.half_height_ = half_tangent(vertical_fov_degrees);
  camera.half_width_ = camera.half_height_ * aspect;
  return camera;
}

Camera Camera::look_at(const CameraSetting& setting, double aspect) {
  const glm::dvec3 view = setting.target - setting.eye;
  const bool vertical = view.x == 0.0 && view.z == 0.0;
  const glm::dvec3 up = vertical ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0);
  return look_at(setting.eye, setting.target, setting.up.value_or(up),
                 setting.fov.value_or(kDefaultFov), aspect);
}

Camera Camera::frame(const Scene& scene, double aspect, double vertical_fov_degrees) {
  return look_at(framing(scene, aspect, vertical_fov_degrees), aspect);
}

CameraSetting framing(const Scene& scene, double aspect, double fov) {
  const Box box = bounding_box(scene);
  const glm::dvec3 centre = 0.5 * (box.low + box.high);
  const glm::dvec3 half = 0.5 * (box.high - box.low);

  // A tall scene (or the inside of a box) is seen nearly level, a flat one from higher up.
  const double flatness = 1.0 - std::min(1.0, half.y / std::max(half.x, half.z));
  const SineCosine<double> raised = sine_cosine((3.0 + 27.0 * flatness) / 360.0);
  const glm::dvec3 towards_eye(0.0, raised.sine, raised.cosine);
  const glm::dvec3 y_axis(0.0, 1.0, 0.0);
  const Camera at_centre =
      Camera::look_at(centre + towards_eye * largest(half), centre, y_axis, fov, aspect);

  // The least distance at which the eight corners are within the four sides of the view.
  constexpr double kFilled = 0.96;
  const double half_height = half_tangent(fov);
  const double half_width = half_height * aspect;
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 offset =
        half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const double nearer = -glm::dot(offset, at_centre.forward());
    const double across = std::abs(glm::dot(offset, at_centre.right())) / half_width;
    const double upwards = std::abs(glm::dot(offset, at_centre.up())) / half_height;
    distance = std::max(distance, std::max(across, upwards) / kFilled + nearer);
  }
  return {centre + distance * towards_eye, centre, y_axis, fov};
}

glm::vec3 Camera::direction(double x, double y) const {
  return scaled_direction(forward_ + (2.0 * x - 1.0) * half_width_ * right_ +
                          (1.0 - 2.0 * y) * half_height_ * up_);
}

}  // namespace raygate
