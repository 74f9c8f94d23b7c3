#include "host/scene/camera.h"

#include <cmath>
#include <string>

#include "host/base/elementary.h"
#include "host/base/input_error.h"

namespace raygate {
namespace {

std::string text(const glm::dvec3& v) {
  return "(" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + ")";
}

}  // namespace

Camera Camera::look_at(const CameraSetting& setting, double aspect) {
  const auto& [eye, target, given_up, fov, lens] = setting;
  const glm::dvec3 view = target - eye;
  const bool is_vertical = view.x == 0.0 && view.z == 0.0;
  const glm::dvec3 usual_up = is_vertical ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 up = given_up.value_or(usual_up);
  const auto require = [&](bool is_met, const char* expected) {
    if (is_met) return;
    throw InputError("camera: found eye " + text(setting.eye) + ", target " + text(setting.target) +
                     ", up " + text(up) + ", expected " + expected);
  };
  Camera camera;
  camera.eye_ = glm::vec3(eye);
  require(is_finite(view) && is_finite(camera.eye_) && is_finite(up),
          "finite numbers within the range of float");
  require(largest(view) > 0.0, "a target other than the eye");
  camera.forward_ = unit(view);
  const glm::dvec3 sideways = largest(up) == 0.0 ? up : glm::cross(camera.forward_, unit(up));
  require(glm::length(sideways) >= 1e-9, "an up direction across the view");
  camera.right_ = glm::normalize(sideways);
  camera.up_ = glm::cross(camera.right_, camera.forward_);
  camera.vertical_fov_degrees_ = fov.value_or(kDefaultFov);
  const SineCosine<double> half = sine_cosine(camera.vertical_fov_degrees_ / 720.0);
  camera.half_height_ = half.sine / half.cosine;
  camera.half_width_ = camera.half_height_ * aspect;
  camera.projection_ = lens.projection.value_or(Projection::kPerspective);
  camera.aperture_ = lens.aperture.value_or(0.0);
  camera.distance_ = glm::length(view);
  camera.focus_ = lens.focus.value_or(camera.distance_);
  return camera;
}

/// Models a thin lens: all rays of an image point meet in the plane of focus.
Ray Camera::ray(double x, double y, const glm::dvec2& lens) const {
  const double across = 2.0 * x - 1.0, along = 1.0 - 2.0 * y;
  const glm::dvec3 offset = across * half_width_ * right_ + along * half_height_ * up_;
  glm::dvec3 origin(eye_), towards = forward_;
  if (projection_ == Projection::kOrthographic) {
    origin += distance_ * offset;
  } else {
    towards += offset;
  }
  if (aperture_ > 0.0) {
    const glm::dvec3 sharp = origin + focus_ * towards;
    origin += lens_offset(lens);
    towards = sharp - glm::dvec3(glm::vec3(origin));
  }
  return {glm::vec3(origin), scaled_direction(towards)};
}

glm::dvec3 Camera::lens_offset(const glm::dvec2& lens) const {
  const SineCosine<double> turn = sine_cosine(lens.y);
  return aperture_ * std::sqrt(lens.x) * (turn.cosine * right_ + turn.sine * up_);
}

glm::dvec3 Camera::lens_point(const glm::dvec2& lens) const {
  return aperture_ > 0.0 ? glm::dvec3(eye_) + lens_offset(lens) : glm::dvec3(eye_);
}

/// Finds the image point whose ray through the lens's centre meets this ray in the plane of focus.
std::optional<glm::dvec2> Camera::place_of(const glm::dvec3& point,
                                           const glm::dvec3& lens_point) const {
  const glm::dvec3 offset = point - lens_point;
  const double distance = glm::dot(offset, forward_);
  if (!(distance > 0.0)) return std::nullopt;
  const glm::dvec3 at = (lens_point - glm::dvec3(eye_)) / focus_ + offset / distance;
  return glm::dvec2(0.5 + 0.5 * glm::dot(at, right_) / half_width_,
                    0.5 - 0.5 * glm::dot(at, up_) / half_height_);
}

glm::vec3 Camera::direction(double x, double y) const {
  return scaled_direction(forward_ + (2.0 * x - 1.0) * half_width_ * right_ +
                          (1.0 - 2.0 * y) * half_height_ * up_);
}

}  // namespace raygate
