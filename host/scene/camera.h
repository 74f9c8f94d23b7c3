// A pinhole camera: where rays begin, and which way the ray of a point of the picture goes.
#pragma once

#include <glm/glm.hpp>

#include "host/scene/camera_setting.h"
#include "host/scene/scene.h"

namespace raygate {

/// Coordinates are the scene's (a world point minus Scene::origin). Right-handed: seen from the
/// eye, `right` is +x and `up` is +y of the picture, and the view goes along `forward`.
class Camera {
 public:
  /// From the lower to the upper edge, where nobody says otherwise.
  static constexpr double kDefaultFov = 35.0;

  /// Looks from `eye` towards `target`, with `up` upwards in the picture.
  /// `vertical_fov_degrees` is the angle from the lower to the upper edge, in (0, 180);
  /// `aspect` is width / height of the picture.
  /// Throws InputError: eye and target coincide, up is zero or along the view, an angle or an
  /// aspect out of range, any number that is not finite.
  [[nodiscard]] static Camera look_at(const glm::dvec3& eye, const glm::dvec3& target,
                                      const glm::dvec3& up, double vertical_fov_degrees,
                                      double aspect);

  /// Looks as `setting` says. Without `up`, +y is up; where the view goes along it, up is what a
  /// map has there, -z. Without `fov` it is kDefaultFov. Throws as above.
  [[nodiscard]] static Camera look_at(const CameraSetting& setting, double aspect);

  /// Looks at all of a scene from the front: see front_view().
  [[nodiscard]] static Camera frame(const Scene& scene, double aspect,
                                    double vertical_fov_degrees = kDefaultFov);

  /// The common origin of all camera rays.
  [[nodiscard]] const glm::vec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& right() const { return right_; }      ///< unit length
  [[nodiscard]] const glm::dvec3& up() const { return up_; }            ///< unit length
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }  ///< unit length
  [[nodiscard]] double vertical_fov_degrees() const { return vertical_fov_degrees_; }

  /// Of the picture, at distance 1 along forward().
  [[nodiscard]] double half_height() const { return half_height_; }

  /// The direction of the ray through a point of the picture: x from 0 (left edge) to 1 (right),
  /// y from 0 (upper edge) to 1 (lower), so that pixel (i, j) has its centre at
  /// ((i + 0.5) / width, (j + 0.5) / height). Scaled as scaled_direction says.
  [[nodiscard]] glm::vec3 direction(double x, double y) const;

 private:
  glm::vec3 eye_{0.0f};
  glm::dvec3 right_{1.0, 0.0, 0.0}, up_{0.0, 1.0, 0.0}, forward_{0.0, 0.0, -1.0};
  double vertical_fov_degrees_ = 0.0;
  double half_width_ = 1.0, half_height_ = 1.0;  // of the picture, at distance 1 along forward
};

}  // namespace raygate
