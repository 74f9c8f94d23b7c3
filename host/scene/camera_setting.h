// Camera settings as a user or a file gives them, and those of a frame of an animation.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

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
