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
  glm::dvec3 origin(eye_), towards = forward_;
  switch (projection_) {
    case Projection::kPerspective:
      towards += across * half_width_ * right_ + along * half_height_ * up_;
      break;
    case Projection::kOrthographic:
      origin += distance_ * (across * half_width_ * right_ + along * half_height_ * up_);
      break;
    case Projection::kPanorama: {
      const SineCosine<double> turn = sine_cosine(0.5 * across), angle = sine_cosine(0.5 * y);
      towards = angle.sine * (turn.cosine * forward_ + turn.sine * right_) + angle.cosine * up_;
      break;
    }
  }
  if (aperture_ > 0.0) {
    const glm::dvec3 sharp = origin + focus_ * towards;
    // Perpendicular to the view; a panorama's lens turns with the ray.
    glm::dvec3 u = right_, v = up_;
    if (projection_ == Projection::kPanorama) {
      const SineCosine<double> turn = sine_cosine(0.5 * across);
      u = turn.cosine * right_ - turn.sine * forward_;
      v = glm::cross(u, towards);
    }
    const SineCosine<double> turn = sine_cosine(lens.y);
    origin += aperture_ * std::sqrt(lens.x) * (turn.cosine * u + turn.sine * v);
    towards = sharp - glm::dvec3(glm::vec3(origin));
  }
  return {glm::vec3(origin), scaled_direction(towards)};
}

glm::dvec3 Camera::lens_point(const glm::dvec2& lens) const {
  if (!(aperture_ > 0.0)) return glm::dvec3(eye_);
  const SineCosine<double> turn = sine_cosine(lens.y);
  return glm::dvec3(eye_) +
         aperture_ * std::sqrt(lens.x) * (turn.cosine * right_ + turn.sine * up_);
}

/// Finds the image point whose ray through the lens's centre meets the same focus point.
std::optional<glm::dvec2> Camera::place_of(const glm::dvec3& point,
                                           const glm::dvec3& lens_point) const {
  const glm::dvec3 offset = point - lens_point;
  const double distance = glm::dot(offset, forward_);
  if (!(distance > 0.0)) return std::nullopt;
  const glm::dvec3 at = (lens_point - glm::dvec3(eye_)) / focus_ + offset / distance;
  return glm::dvec2(0.5 + 0.5 * glm::dot(at, right_) / half_width_,
                    0.5 - 0.5 * glm::dot(at, up_) / half_height_);
}

double Camera::depth(const glm::dvec3& point) const {
  return projection_ == Projection::kPanorama ? glm::length(point) : glm::dot(point, forward_);
}

glm::vec3 Camera::direction(double x, double y) const {
  return scaled_direction(forward_ + (2.0 * x - 1.0) * half_width_ * right_ +
                          (1.0 - 2.0 * y) * half_height_ * up_);
}

}  // namespace raygate
