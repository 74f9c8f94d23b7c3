// Camera: maps points of the image to rays.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <utility>

#include "host/exact/exact.h"

namespace raygate {

/// Mapping from image positions to ray directions.
enum class Projection {
  kPerspective,
  kOrthographic,  ///< parallel rays; objects at the target look as large as in perspective
};

/// Projection and lens of a camera. Unset members have the defaults given here.
struct LensSetting {
  std::optional<Projection> projection;  ///< default: kPerspective
  /// Radius of the lens, at least 0; default: 0 (everything is sharp).
  std::optional<double> aperture;
  /// Distance of the plane of focus from the lens along the view; default: the target's distance.
  std::optional<double> focus;

  /// Returns these settings, overridden by those that are set in `other`.
  [[nodiscard]] LensSetting overridden_by(const LensSetting& other) const {
    return {other.projection ? other.projection : projection,
            other.aperture ? other.aperture : aperture, other.focus ? other.focus : focus};
  }
};

/// Position, orientation and lens of a camera.
struct CameraSetting {
  glm::dvec3 eye{0.0}, target{0.0};  ///< must differ
  /// Up direction in the image; not zero or parallel to the view; default: +y.
  std::optional<glm::dvec3> up = {};
  /// Vertical field of view in degrees, in (0, 180); default: kDefaultFov.
  std::optional<double> fov = {};
  LensSetting lens = {};
};

/// The user's choice of a camera, in world coordinates; unset members are chosen to suit the scene.
struct CameraRequest {
  std::optional<CameraSetting> camera;  ///< none: the scene's camera, or a view of the whole scene
  /// Azimuth and elevation in degrees: a view of the whole scene, instead of the scene's camera.
  std::optional<std::pair<double, double>> angles;
  std::optional<glm::dvec3> eye, target;  ///< replace eye and target of the camera or view
  std::optional<glm::dvec3> up;           ///< up direction of the camera or view
  std::optional<double> fov;              ///< vertical field of view, in degrees
  LensSetting lens;
  std::optional<bool> ground;  ///< whether to add a ground; unset: only if a default view needs it
};

/// The names of projections in scene files and on the command line.
inline constexpr std::pair<const char*, Projection> kProjections[] = {
    {"perspective", Projection::kPerspective}, {"orthographic", Projection::kOrthographic}};

/// A camera, in coordinates relative to Scene::origin. Its frame is right-handed: in the image,
/// `right` is +x and `up` is +y, and the camera looks along `forward`.
class Camera {
 public:
  /// Default vertical field of view in degrees.
  static constexpr double kDefaultFov = 35.0;

  /// Returns the camera of `setting`, whose angle and lens must be in range. `aspect`: the image's
  /// width over its height. The default of `up` is +y, or -z for a view parallel to y. Throws
  /// InputError if a vector is not finite, eye and target coincide or `up` is parallel to the view.
  [[nodiscard]] static Camera look_at(const CameraSetting& setting, double aspect);

  /// Returns the common origin of all rays, or the centre of the image for an orthographic camera.
  [[nodiscard]] const glm::vec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& right() const { return right_; }      ///< unit length
  [[nodiscard]] const glm::dvec3& up() const { return up_; }            ///< unit length
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }  ///< unit length
  [[nodiscard]] double vertical_fov_degrees() const { return vertical_fov_degrees_; }

  /// Returns half the height of the image plane at distance 1 along forward().
  [[nodiscard]] double half_height() const { return half_height_; }

  /// Returns whether this is a perspective camera without a lens: its rays fill a pyramid.
  [[nodiscard]] bool is_pinhole() const {
    return projection_ == Projection::kPerspective && aperture_ == 0.0;
  }
  [[nodiscard]] Projection projection() const { return projection_; }
  [[nodiscard]] double aperture() const { return aperture_; }
  [[nodiscard]] double focus() const { return focus_; }

  /// Returns the ray through a point of the image (coordinates as for direction()) and a point of
  /// the lens, given by a point of the unit square. (0, 0) is the centre of the lens.
  [[nodiscard]] Ray ray(double x, double y, const glm::dvec2& lens) const;
  /// Returns the point of a perspective camera's lens for a point of the unit square.
  [[nodiscard]] glm::dvec3 lens_point(const glm::dvec2& lens) const;
  /// Returns the image coordinates of a perspective camera's ray through `lens_point` and `point`:
  /// the inverse of ray(). Returns nullopt if `point` is not in front of the camera.
  [[nodiscard]] std::optional<glm::dvec2> place_of(const glm::dvec3& point,
                                                   const glm::dvec3& lens_point) const;
  /// Returns the area of the image plane at distance 1 along forward().
  [[nodiscard]] double picture_area() const { return 4.0 * half_width_ * half_height_; }

  /// Returns the direction of the pinhole ray through a point of the image: x from 0 (left edge) to
  /// 1 (right), y from 0 (upper edge) to 1 (lower). The length is that of scaled_direction().
  [[nodiscard]] glm::vec3 direction(double x, double y) const;

 private:
  /// Returns lens_point() relative to the eye.
  [[nodiscard]] glm::dvec3 lens_offset(const glm::dvec2& lens) const;

  glm::vec3 eye_{0.0f};
  glm::dvec3 right_{1.0, 0.0, 0.0}, up_{0.0, 1.0, 0.0}, forward_{0.0, 0.0, -1.0};
  double vertical_fov_degrees_ = 0.0;
  double half_width_ = 1.0, half_height_ = 1.0;  // of the image plane at distance 1 along forward_
  Projection projection_ = Projection::kPerspective;
  double aperture_ = 0.0, focus_ = 1.0, distance_ = 1.0;  // distance_: of the target
};

}  // namespace raygate
