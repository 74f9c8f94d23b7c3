// Camera options: the view, what the camera looks through, and the environment around the scene.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/options/option_table.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace raygate {

/// From where the scene is seen. What is empty is the scene file's, or settled by CameraSequence.
struct CameraOptions {
  std::optional<CameraSetting> camera;  ///< in the file's coordinates; none: a view
  /// Azimuth and elevation in degrees: the scene from there, whatever cameras there are.
  std::optional<std::pair<double, double>> angles;
  std::optional<glm::dvec3> up;  ///< of the camera, or of the view
  std::optional<double> fov;
  LensSetting lens;
  std::vector<CameraSetting> path;  ///< of an animation; empty: once around the target
  std::optional<bool> ground;       ///< none: where a default view needs it
};

/// Adds to a table what sets `options`, or the environment.
void add_camera_options(OptionTable& table, CameraOptions& options);
void add_environment_options(OptionTable& table, std::optional<EnvironmentSetting>& environment);

/// The options of lens and environment that say the same again, but for defaults: names and values.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> camera_option_values(
    const Camera& camera, const std::optional<EnvironmentSetting>& environment);

}  // namespace raygate
