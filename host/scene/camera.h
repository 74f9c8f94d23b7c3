// Camera: origin and direction of the ray through each point of the picture.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

/// How directions become places of the picture.
enum class Projection {
  kPerspective,
  kOrthographic,  ///< all rays along the view: as large as perspective has it at the target
  kPanorama,      ///< all directions, as EnvironmentMap has them; the target is in the middle
};

/// What a camera looks through; what is left out has a default.
struct LensSetting {
  std::optional<Projection> projection;  ///< kPerspective
  std::optional<double> aperture;        ///< radius of the lens; 0, which is sharp everywhere
  /// From the lens along the view to what is sharp; the target's distance. Of a panorama from the
  /// eye.
  std::optional<double> focus;

  /// These, where `other` does not say something else.
  [[nodiscard]] LensSetting overridden_by(const LensSetting& other) const {
    return {other.projection ? other.projection : projection,
            other.aperture ? other.aperture : aperture, other.focus ? other.focus : focus};
  }
};

/// What is left out has a default.
struct CameraSetting {
  glm::dvec3 eye{0.0}, target{0.0};  ///< not the same point
  std::optional<glm::dvec3> up;      ///< upwards in the picture; not zero and not along the view
  std::optional<double> fov;         ///< from the lower to the upper edge in degrees, in (0, 180)
  LensSetting lens = {};
};

/// "perspective", "orthographic" or "panorama".
[[nodiscard]] std::optional<Projection> projection_named(std::string_view name);
[[nodiscard]] std::string_view to_string(Projection projection);

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
  /// map has there, -z. Without `fov` it is kDefaultFov. Throws as above, and for an aperture that
  /// is negative, or a focus that is not positive.
  [[nodiscard]] static Camera look_at(const CameraSetting& setting, double aspect);

  /// The origin of all camera rays, where has_common_origin(); of orthographic ones the middle.
  [[nodiscard]] const glm::vec3& eye() const { return eye_; }
  [[nodiscard]] const glm::dvec3& right() const { return right_; }      ///< unit length
  [[nodiscard]] const glm::dvec3& up() const { return up_; }            ///< unit length
  [[nodiscard]] const glm::dvec3& forward() const { return forward_; }  ///< unit length
  [[nodiscard]] double vertical_fov_degrees() const { return vertical_fov_degrees_; }

  /// Of the picture, at distance 1 along forward().
  [[nodiscard]] double half_height() const { return half_height_; }

  /// Whether all rays begin at the eye: not those of an orthographic camera, or of a lens.
  [[nodiscard]] bool has_common_origin() const {
    return projection_ != Projection::kOrthographic && aperture_ == 0.0;
  }
  /// Whether rays begin at the eye and fill the pyramid around direction()'s corners.
  [[nodiscard]] bool is_pinhole() const {
    return projection_ == Projection::kPerspective && aperture_ == 0.0;
  }
  [[nodiscard]] Projection projection() const { return projection_; }
  [[nodiscard]] double aperture() const { return aperture_; }
  [[nodiscard]] double focus() const { return focus_; }

  /// The ray through a point of the picture, places as in direction(), and through the point of
  /// the lens that a point of the unit square stands for; (0, 0) is its middle.
  [[nodiscard]] Ray ray(double x, double y, const glm::dvec2& lens) const;
  /// Of a perspective camera: the point of the lens that a point of the unit square stands for,
  [[nodiscard]] glm::dvec3 lens_point(const glm::dvec2& lens) const;
  /// and the place in the picture of the ray through that and `point`: ray() the other way round.
  /// None where `point` is not before the camera.
  [[nodiscard]] std::optional<glm::dvec2> place_of(const glm::dvec3& point,
                                                   const glm::dvec3& lens_point) const;
  /// The area of the picture at distance 1 along forward().
  [[nodiscard]] double picture_area() const { return 4.0 * half_width_ * half_height_; }
  /// How far a point is along the camera's axis, or of a panorama from the eye; `point` is relative
  /// to that.
  [[nodiscard]] double depth(const glm::dvec3& point) const;

  /// The direction of the pinhole camera's ray through a point of the picture: x from 0 (left edge)
  /// to 1 (right), y from 0 (upper edge) to 1 (lower), so that pixel (i, j) has its centre at
  /// ((i + 0.5) / width, (j + 0.5) / height). Scaled as scaled_direction says.
  [[nodiscard]] glm::vec3 direction(double x, double y) const;

 private:
  glm::vec3 eye_{0.0f};
  glm::dvec3 right_{1.0, 0.0, 0.0}, up_{0.0, 1.0, 0.0}, forward_{0.0, 0.0, -1.0};
  double vertical_fov_degrees_ = 0.0;
  double half_width_ = 1.0, half_height_ = 1.0;  // of the picture, at distance 1 along forward
  Projection projection_ = Projection::kPerspective;
  double aperture_ = 0.0, focus_ = 1.0, distance_ = 1.0;  // distance: of the target
};

}  // namespace raygate
